//! Marks over a picture, on the GPU.

use super::context::Context;
use super::present::PresentPass;
use super::storage::Storage;
use crate::device::FinishJob;
use layout::present::MARKED_ACROSS;
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;

/// The kernel for it, what it reads, and the picture that comes of it.
#[derive(Debug)]
pub(super) struct Laying {
    pass: PresentPass,
    pixels: Storage,
    layers: Storage,
    marked: Storage,
}

impl Laying {
    pub(super) fn new(context: &Context) -> Self {
        let storage = |label| Storage::new(context, label);
        Self {
            pass: PresentPass::new(context, PresentKernel::Layers),
            pixels: storage("pixels with marks"),
            layers: storage("layers of marks"),
            marked: storage("picture with marks"),
        }
    }

    /// A copy of a picture with its marks.
    pub(super) fn lay(&mut self, context: &Context, picture: &Storage, job: &FinishJob) -> &Storage {
        let bytes = 16 * (job.raster.width * job.raster.height) as u64;
        self.marked.reserve(context, bytes);
        self.pixels.write(context, job.layers.pixels());
        self.layers.write(context, job.layers.layers());
        let mut encoder = context.new_encoder();
        encoder.copy_buffer_to_buffer(&picture.buffer, 0, &self.marked.buffer, 0, bytes);
        context.submit(encoder);
        let count = job.layers.pixels().len() as u32;
        let block = PresentBlock {
            raster: [MARKED_ACROSS, count.div_ceil(MARKED_ACROSS), 0, 0],
            stages: [count, 0, 0, 0],
            ..PresentBlock::default()
        };
        let others = [
            (binding::MARKED_PIXELS, &self.pixels),
            (binding::LAYERS, &self.layers),
            (binding::MARKED, &self.marked),
        ];
        self.pass.run(context, &block, picture, &others);
        &self.marked
    }
}
