//! From the picture of one projector to its codes, on the GPU.

use super::context::Context;
use super::present::PresentPass;
use super::storage::Storage;
use crate::device::FinishJob;
use crate::present::Finisher;
use layout::present::{HAS_BLACK_MAP, HAS_BLEND, HAS_WARP, IS_DITHERED};
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;
use std::collections::HashMap;

/// The kernel for it, the tables of each view, and the codes of the picture at which it is.
#[derive(Debug)]
pub(super) struct Finishing {
    pass: PresentPass,
    views: HashMap<usize, Tables>,
    codes: Storage,
}

impl Finishing {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            pass: PresentPass::new(PresentKernel::Finish),
            views: HashMap::new(),
            codes: Storage::new(context, "codes"),
        }
    }

    /// Notes the codes of a picture, the `place`th of a submission: what will hold a word for each pixel, until the next is
    /// made.
    pub(super) fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        picture: &Storage,
        job: &FinishJob,
    ) -> &wgpu::Buffer {
        self.codes.reserve(context, code_bytes(job));
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
        self.pass.note((context, encoder), place, &block, picture, &others);
        &self.codes.buffer
    }
}

/// Bytes of a picture's codes on the device: a word for each pixel.
pub(super) fn code_bytes(job: &FinishJob) -> u64 {
    4 * (job.raster.width * job.raster.height) as u64
}

/// Red, green and blue of each pixel of them.
pub(super) fn unpacked(words: &[u8]) -> Vec<u8> {
    words.chunks_exact(4).flat_map(|word| [word[0], word[1], word[2]]).collect()
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
