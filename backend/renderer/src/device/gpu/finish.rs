//! From the picture of one projector to its codes, on the GPU.

use super::context::Context;
use super::kept::KeptCodes;
use super::present::PresentPass;
use super::storage::{Storage, Stretch};
use crate::device::FinishJob;
use crate::present::Finisher;
use layout::present::{HAS_BLACK_MAP, HAS_BLEND, HAS_WARP, IS_DITHERED};
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;
use std::collections::HashMap;

/// The kernel for it, and the tables of each view.
#[derive(Debug)]
pub(super) struct Finishing {
    pass: PresentPass,
    views: HashMap<usize, Tables>,
}

impl Finishing {
    pub(super) fn new() -> Self {
        Self { pass: PresentPass::new(PresentKernel::Finish), views: HashMap::new() }
    }

    /// Notes the codes of a picture, the `place`th of a submission.
    pub(super) fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        (picture, codes): (&Stretch, &KeptCodes),
        job: &FinishJob,
    ) {
        let tables = self.views.entry(job.view).or_insert_with(|| Tables::new(context, job.finisher));
        let block = PresentBlock {
            raster: [job.raster.width as u32, job.raster.height as u32, 0, 0],
            stages: [0, tables.stages, 0, 0],
            black: tables.black_level,
            ..PresentBlock::default()
        };
        let others = [
            (binding::PLACES, tables.places.whole()),
            (binding::BLEND, tables.blend.whole()),
            (binding::BLACK, tables.black.whole()),
            (binding::CURVES, tables.curves.whole()),
            (binding::CODES, codes.stretch()),
        ];
        self.pass.note((context, encoder), place, &block, picture, &others);
    }
}

/// What a finisher knows, on the device.
#[derive(Debug)]
struct Tables {
    places: Storage,
    blend: Storage,
    black: Storage,
    black_level: [f32; 4],
    curves: Storage,
    stages: u32,
}

impl Tables {
    fn new(context: &Context, finisher: &Finisher) -> Self {
        let tables = finisher.tables();
        let storage = |label| Storage::new(context, label);
        let mut on_device = Self {
            places: storage("places of a warp"),
            blend: storage("blend"),
            black: storage("black level"),
            black_level: [0.0; 4],
            curves: storage("transfer curves"),
            stages: if tables.is_dithered { IS_DITHERED } else { 0 },
        };
        on_device.black_level[..3].copy_from_slice(&tables.black_level);
        on_device.curves.write(context, &tables.curves);
        let mut stage = |stage: u32, has: bool| on_device.stages |= if has { stage } else { 0 };
        stage(HAS_WARP, tables.places.is_some());
        stage(HAS_BLEND, tables.blend.is_some());
        stage(HAS_BLACK_MAP, tables.black.is_some());
        on_device.places.write_if_any(context, tables.places.unwrap_or_default());
        on_device.blend.write_if_any(context, tables.blend.unwrap_or_default());
        on_device.black.write_if_any(context, tables.black.unwrap_or_default());
        on_device
    }
}
