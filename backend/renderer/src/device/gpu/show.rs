//! What is shown of a picture: gaps filled, and no pixel changed by more than it may.

use super::arena::Arena;
use super::context::Context;
use super::present::PresentPass;
use super::readback::Readback;
use super::storage::Storage;
use super::view::ViewBuffers;
use crate::device::{DeviceError, ShowJob};
use crate::present::{Pass, Thresholds, passes};
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;

/// Passes of a reconstruction, at most.
const MOST_PASSES: usize = 2;

/// The kernels for it, and room for pictures between two of them.
#[derive(Debug)]
pub(super) struct Showing {
    reconstruct: [PresentPass; MOST_PASSES],
    whole: [Storage; MOST_PASSES],
    ease: PresentPass,
    behind_back: Readback,
}

impl Showing {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            reconstruct: [(); MOST_PASSES].map(|()| PresentPass::new(PresentKernel::Reconstruct)),
            whole: [(); MOST_PASSES].map(|()| Storage::new(context, "picture without gaps")),
            ease: PresentPass::new(PresentKernel::Ease),
            behind_back: Readback::new(),
        }
    }

    /// Makes what is shown of the pixels of each view. Whether any of it is behind them.
    pub(super) fn show(
        &mut self,
        context: &Context,
        arenas: &[Arena],
        views: &mut [ViewBuffers],
        jobs: &[ShowJob],
    ) -> Result<Vec<bool>, DeviceError> {
        let mut encoder = context.new_encoder();
        self.behind_back.begin(context, 4 * jobs.len() as u64);
        for (place, job) in jobs.iter().enumerate() {
            self.note((context, &mut encoder), place, arenas, &mut views[job.picture], job);
        }
        context.submit(encoder);
        // Whether any picture is behind is waited for only where one can be.
        let behind: Vec<u32> = self.behind_back.items(context)?;
        let mut behind = behind.into_iter();
        Ok(jobs.iter().map(|job| eases(job) && behind.next() != Some(0)).collect())
    }

    fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        arenas: &[Arena],
        view: &mut ViewBuffers,
        job: &ShowJob,
    ) {
        let pixels = view.cast_colours(arenas);
        let bytes = pixels.bytes;
        view.shown.reserve(context, bytes);
        let mut whole = None;
        for (i, pass) in passes(job.known).enumerate() {
            self.whole[i].reserve(context, bytes);
            let (done, rest) = self.whole.split_at(i);
            let picture = done.last().map_or(pixels, Storage::whole);
            let others = [(binding::BEFORE, view.shown.whole()), (binding::WHOLE, rest[0].whole())];
            let block = reconstruction(job, &pass);
            self.reconstruct[i].note((context, &mut *encoder), place, &block, &picture, &others);
            whole = Some(i);
        }
        let picture = whole.map_or(pixels, |i| self.whole[i].whole());
        encoder.clear_buffer(&view.behind.buffer, 0, None);
        let others = [(binding::SHOWN, view.shown.whole()), (binding::BEHIND, view.behind.whole())];
        self.ease.note((context, &mut *encoder), place, &easing(job), &picture, &others);
        if eases(job) {
            self.behind_back.copy(encoder, &view.behind.stretch(0, 4));
        }
    }
}

/// Whether a picture may fall behind what was cast.
fn eases(job: &ShowJob) -> bool {
    job.has_before && job.most_change.is_some()
}

fn reconstruction(job: &ShowJob, pass: &Pass) -> PresentBlock {
    let Thresholds { low, high } = Thresholds::default();
    let mut steps = [[0; 4]; layout::present::MOST_PAIRS];
    steps.iter_mut().zip(pass.pairs).for_each(|(into, &[x, y])| *into = [x, y, 0, 0]);
    PresentBlock {
        raster: [
            job.raster.width as u32,
            job.raster.height as u32,
            pass.missing.bits(),
            pass.pairs.len() as u32,
        ],
        steps,
        numbers: [low, high, 0.0, 0.0],
        stages: [job.has_before.into(), 0, 0, 0],
        ..PresentBlock::default()
    }
}

fn easing(job: &ShowJob) -> PresentBlock {
    PresentBlock {
        raster: [job.raster.width as u32, job.raster.height as u32, 0, 0],
        numbers: [0.0, 0.0, job.most_change.unwrap_or_default(), 0.0],
        stages: [eases(job).into(), 0, 0, 0],
        ..PresentBlock::default()
    }
}
