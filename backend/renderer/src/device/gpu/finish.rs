//! From the picture of one projector to its codes, on the GPU.

use super::context::Context;
use super::present::PresentPass;
use super::storage::{Storage, Stretch};
use crate::device::FinishJob;
use crate::present::Finisher;
use layout::present::{CODED_PIXELS, HAS_BLACK_MAP, HAS_BLEND, HAS_WARP, IS_DITHERED};
use layout::{PresentBlock, binding};
use shaders::compose::PresentKernel;
use std::collections::HashMap;

/// The kernel for it, the tables of each view, and the codes of the pictures of a submission.
#[derive(Debug)]
pub(super) struct Finishing {
    pass: PresentPass,
    views: HashMap<usize, Tables>,
    codes: Storage,
    /// Bytes of them that are some picture's.
    used_bytes: u64,
}

impl Finishing {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            pass: PresentPass::new(PresentKernel::Finish),
            views: HashMap::new(),
            codes: Storage::new(context, "codes"),
            used_bytes: 0,
        }
    }

    /// Makes room for the codes of a submission, of so many bytes with what lies between pictures.
    pub(super) fn begin(&mut self, context: &Context, bytes: u64) {
        self.codes.reserve(context, bytes);
        self.used_bytes = 0;
    }

    /// Those of all pictures that were noted since.
    pub(super) fn codes(&self) -> Stretch<'_> {
        self.codes.stretch(0, self.used_bytes)
    }

    /// Notes the codes of a picture, the `place`th of a submission, behind those of the one before.
    pub(super) fn note(
        &mut self,
        (context, encoder): (&Context, &mut wgpu::CommandEncoder),
        place: usize,
        picture: &Stretch,
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
            (binding::CODES, self.codes.stretch(self.used_bytes, code_bytes(job))),
        ];
        self.pass.note((context, encoder), place, &block, picture, &others);
        self.used_bytes += code_room(job);
    }
}

/// Bytes of a row of codes on the device.
fn row_bytes(job: &FinishJob) -> usize {
    3 * job.raster.width.next_multiple_of(CODED_PIXELS as usize)
}

/// Bytes of a picture's codes on the device.
fn code_bytes(job: &FinishJob) -> u64 {
    (row_bytes(job) * job.raster.height) as u64
}

/// The same, until the next picture's may begin: at whole multiples of as many bytes as parts of buffers that are bound have to.
pub(super) fn code_room(job: &FinishJob) -> u64 {
    code_bytes(job).next_multiple_of(256)
}

/// Red, green and blue of each pixel, from what the device has in a picture's room.
pub(super) fn unpacked(bytes: &[u8], job: &FinishJob) -> Vec<u8> {
    let (row, width) = (row_bytes(job), 3 * job.raster.width);
    let bytes = &bytes[..row * job.raster.height];
    if row == width {
        bytes.to_vec()
    } else {
        bytes.chunks(row).flat_map(|row| &row[..width]).copied().collect()
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
