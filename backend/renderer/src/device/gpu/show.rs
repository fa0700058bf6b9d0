//! What is shown of a picture: gaps filled, and no pixel changed by more than it may.

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
    behind: Storage,
    behind_back: Readback,
}

impl Showing {
    pub(super) fn new(context: &Context) -> Self {
        let pass = |kernel| PresentPass::new(context, kernel);
        Self {
            reconstruct: [(); MOST_PASSES].map(|()| pass(PresentKernel::Reconstruct)),
            whole: [(); MOST_PASSES].map(|()| Storage::new(context, "picture without gaps")),
            ease: pass(PresentKernel::Ease),
            behind: Storage::new(context, "whether a picture is behind"),
            behind_back: Readback::new(),
        }
    }

    /// Makes what is shown of a view's pixels. Whether any of it is behind them.
    pub(super) fn show(
        &mut self,
        context: &Context,
        view: &mut ViewBuffers,
        job: &ShowJob,
    ) -> Result<bool, DeviceError> {
        let bytes = 16 * view.pixel_count() as u64;
        view.shown.reserve(context, bytes);
        let mut whole = None;
        for (i, pass) in passes(job.known).enumerate() {
            self.whole[i].reserve(context, bytes);
            let (done, rest) = self.whole.split_at(i);
            let picture = done.last().unwrap_or(&view.pixels);
            let others = [(binding::BEFORE, &view.shown), (binding::WHOLE, &rest[0])];
            self.reconstruct[i].run(context, &reconstruction(job, &pass), picture, &others);
            whole = Some(i);
        }
        let picture = whole.map_or(&view.pixels, |i| &self.whole[i]);
        let eases = job.has_before && job.most_change.is_some();
        if eases {
            self.behind.write(context, &[0_u32; 16]);
        }
        let others = [(binding::SHOWN, &view.shown), (binding::BEHIND, &self.behind)];
        self.ease.run(context, &easing(job, eases), picture, &others);
        if eases { self.is_behind(context) } else { Ok(false) }
    }

    fn is_behind(&mut self, context: &Context) -> Result<bool, DeviceError> {
        let mut encoder = context.new_encoder();
        self.behind_back.copy(context, &mut encoder, &self.behind.buffer, 4);
        context.run(encoder)?;
        Ok(self.behind_back.read::<u32>(context, 1)? != [0])
    }
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

fn easing(job: &ShowJob, eases: bool) -> PresentBlock {
    PresentBlock {
        raster: [job.raster.width as u32, job.raster.height as u32, 0, 0],
        numbers: [0.0, 0.0, job.most_change.unwrap_or_default(), 0.0],
        stages: [eases.into(), 0, 0, 0],
        ..PresentBlock::default()
    }
}
