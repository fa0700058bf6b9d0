//! The kernels that make what is shown of what was cast, and what they have in common.

use super::context::Context;
use super::kernels::Kernel;
use super::pass::note_pass;
use super::storage::{Stretch, uniform};
use layout::{PresentBlock, TILE_EDGE, binding};
use shaders::compose::PresentKernel;

/// A pass over pictures: a kernel, and a uniform block for each time that it is noted in one submission.
#[derive(Debug)]
pub(super) struct PresentPass {
    kernel: PresentKernel,
    blocks: Vec<wgpu::Buffer>,
}

impl PresentPass {
    pub(super) fn new(kernel: PresentKernel) -> Self {
        Self { kernel, blocks: Vec::new() }
    }

    /// Notes it for the `place`th picture of a submission: it reads `picture`, and reads and writes the other buffers, each under
    /// its binding.
    pub(super) fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        block: &PresentBlock,
        picture: &Stretch,
        others: &[(u32, Stretch)],
    ) {
        let pipeline = context.kernel(Kernel::Present(self.kernel));
        let blocks = self.blocks.len().max(place + 1);
        self.blocks.resize_with(blocks, || uniform::<PresentBlock>(context, "present"));
        let uniform = &self.blocks[place];
        context.queue.write_buffer(uniform, 0, bytemuck::bytes_of(block));
        let mut entries =
            vec![wgpu::BindGroupEntry { binding: binding::PRESENT, resource: uniform.as_entire_binding() }];
        let buffers = [(binding::PICTURE, *picture)].into_iter().chain(others.iter().copied());
        entries.extend(
            buffers.map(|(binding, stretch)| wgpu::BindGroupEntry { binding, resource: stretch.binding() }),
        );
        let [width, height, ..] = block.raster;
        let groups =
            [width.div_ceil(TILE_EDGE * self.kernel.pixels_at_once()), height.div_ceil(TILE_EDGE), 1];
        note_pass(&context.device, encoder, &pipeline, &entries, groups);
    }
}
