//! One pass of a kernel.

/// Workgroups along x of a dispatch, at most.
const GROUPS_ACROSS: u32 = 32768;

/// Notes a pass of so many workgroups along x and y.
pub(super) fn note_pass(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    bind_group: &wgpu::BindGroup,
    [width, height]: [u32; 2],
) {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.dispatch_workgroups(width, height, 1);
}

/// So many workgroups, in rows that a dispatch can have; those beyond the last have nothing to do.
pub(super) fn in_rows(groups: u32) -> [u32; 2] {
    [groups.min(GROUPS_ACROSS), groups.div_ceil(GROUPS_ACROSS)]
}
