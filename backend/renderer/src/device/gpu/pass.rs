//! One pass of a kernel.

/// Workgroups along x of a dispatch, at most.
const GROUPS_ACROSS: u32 = 32768;

/// Notes a pass of so many workgroups along x, y and z, of a kernel that reads and writes these entries.
pub(super) fn note_pass(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    entries: &[wgpu::BindGroupEntry],
    [width, height, depth]: [u32; 3],
) {
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries,
    });
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.dispatch_workgroups(width, height, depth);
}

/// So many workgroups, in rows that a dispatch can have; those beyond the last have nothing to do.
pub(super) fn in_rows(groups: u32) -> [u32; 3] {
    [groups.min(GROUPS_ACROSS), groups.div_ceil(GROUPS_ACROSS), 1]
}
