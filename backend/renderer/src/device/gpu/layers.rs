//! Marks over a picture, on the GPU.

use super::context::Context;
use super::present::PresentPass;
use super::storage::{Storage, Stretch};
use crate::device::FinishJob;
use layout::present::MARKED_ACROSS;
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;

/// The kernel for it, what it reads of each picture, and the one that comes of it.
#[derive(Debug)]
pub(super) struct Laying {
    pass: PresentPass,
    marks: Vec<Marks>,
    marked: Storage,
}

/// Those of one picture.
#[derive(Debug)]
struct Marks {
    pixels: Storage,
    layers: Storage,
}

impl Marks {
    fn new(context: &Context) -> Self {
        let storage = |label| Storage::new(context, label);
        Self { pixels: storage("pixels with marks"), layers: storage("layers of marks") }
    }
}

impl Laying {
    pub(super) fn new(context: &Context) -> Self {
        let marked = Storage::new(context, "picture with marks");
        Self { pass: PresentPass::new(PresentKernel::Layers), marks: Vec::new(), marked }
    }

    /// Notes a copy of a picture with its marks, the `place`th of a submission. The next takes its room.
    pub(super) fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        picture: &Stretch,
        job: &FinishJob,
    ) -> Stretch<'_> {
        let bytes = 16 * (job.raster.width * job.raster.height) as u64;
        self.marked.reserve(context, bytes);
        self.marks.resize_with(self.marks.len().max(place + 1), || Marks::new(context));
        let Marks { pixels, layers } = &mut self.marks[place];
        pixels.write(context, job.layers.pixels());
        layers.write(context, job.layers.layers());
        encoder.copy_buffer_to_buffer(picture.buffer, picture.offset, &self.marked.buffer, 0, bytes);
        let count = job.layers.pixels().len() as u32;
        let block = PresentBlock {
            raster: [MARKED_ACROSS, count.div_ceil(MARKED_ACROSS), 0, 0],
            stages: [count, 0, 0, 0],
            ..PresentBlock::default()
        };
        let others = [
            (binding::MARKED_PIXELS, pixels.whole()),
            (binding::LAYERS, layers.whole()),
            (binding::MARKED, self.marked.whole()),
        ];
        self.pass.note((context, encoder), place, &block, picture, &others);
        self.marked.whole()
    }
}
