//! From the picture of one projector to its codes, on the GPU.

use super::context::Context;
use super::present::PresentPass;
use super::readback::Readback;
use super::storage::Storage;
use crate::device::{DeviceError, FinishJob};
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
    codes: Storage,
    codes_back: Readback,
}

impl Finishing {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            pass: PresentPass::new(context, PresentKernel::Finish),
            views: HashMap::new(),
            codes: Storage::new(context, "codes"),
            codes_back: Readback::new(),
        }
    }

    /// The codes of a picture: three to a pixel.
    pub(super) fn codes(
        &mut self,
        context: &Context,
        picture: &Storage,
        job: &FinishJob,
    ) -> Result<Vec<u8>, DeviceError> {
        let pixels = job.raster.width * job.raster.height;
        self.codes.reserve(context, 4 * pixels as u64);
        let tables = self.views.entry(job.view).or_insert_with(|| Tables::new(context, job.finisher));
        let block = PresentBlock {
            raster: [job.raster.width as u32, job.raster.height as u32, 0, 0],
            stages: [0, tables.stages, 0, 0],
            black: tables.black_level,
            ..PresentBlock::default()
        };
        let others = [
            (binding::PLACES, &tables.places),
            (binding::BLEND, &tables.blend),
            (binding::BLACK, &tables.black),
            (binding::CURVES, &tables.curves),
            (binding::CODES, &self.codes),
        ];
        self.pass.run(context, &block, picture, &others);
        let mut encoder = context.new_encoder();
        self.codes_back.copy(context, &mut encoder, &self.codes.buffer, 4 * pixels as u64);
        context.run(encoder)?;
        let packed: Vec<u32> = self.codes_back.read(context, pixels)?;
        Ok(packed.into_iter().flat_map(|pixel| [0, 8, 16].map(|shift| (pixel >> shift) as u8)).collect())
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
