//! What the GPU keeps of one view: its rays and tiles, its picture and its counts.

use super::context::Context;
use super::readback::Readback;
use super::storage::{Storage, uniform};
use crate::device::job::{CastOutcome, ViewJob};
use crate::device::{CastJob, DeviceError};
use layout::{MISSING, ViewBlock};
use twin::{Lattice, ProjectorRays, ShortRay, Tiling};

/// The buffers of one view.
#[derive(Debug)]
pub(super) struct ViewBuffers {
    /// A [`ViewBlock`].
    pub(super) block: wgpu::Buffer,
    pub(super) tiles: Storage,
    pub(super) pixels: Storage,
    /// What is shown of them.
    pub(super) shown: Storage,
    pub(super) counts: Storage,
    counts_back: Readback,
    /// Width and height of its picture, pixels.
    raster: [u32; 2],
}

impl ViewBuffers {
    pub(super) fn new(context: &Context) -> Self {
        let storage = |label| Storage::new(context, label);
        Self {
            block: uniform::<ViewBlock>(context, "view"),
            tiles: storage("tiles"),
            pixels: storage("pixels"),
            shown: storage("shown pixels"),
            counts: storage("sample counts"),
            counts_back: Readback::new(),
            raster: [0, 0],
        }
    }

    /// Pixels of its picture.
    pub(super) fn pixel_count(&self) -> usize {
        self.raster[0] as usize * self.raster[1] as usize
    }

    /// Uploads what is particular to one cast of the view.
    pub(super) fn prepare(&mut self, context: &Context, view: &ViewJob) {
        let tiling =
            Tiling { lattice: view.grid.lattice, across: view.grid.across, tiles: view.tiles.len() as u32 };
        self.raster = view.rays.raster;
        let pixels = self.pixel_count() as u64;
        self.pixels.reserve(context, 16 * pixels);
        self.counts.reserve(context, 4 * pixels);
        self.tiles.write(context, &view.tiles);
        context.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&view.rays.block(&tiling)));
    }

    /// The same for a list of short rays, each with a colour and a count of its own.
    pub(super) fn prepare_short(&mut self, context: &Context, rays: &ProjectorRays<f32>, short: &[ShortRay]) {
        let count = short.len() as u32;
        self.pixels.reserve(context, 16 * u64::from(count));
        self.counts.reserve(context, 4 * u64::from(count));
        self.tiles.write(context, &short.iter().map(ShortRay::words).collect::<Vec<_>>());
        let tiling = Tiling { lattice: Lattice::ALL, across: 1, tiles: count };
        context.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&rays.block(&tiling)));
    }

    /// Notes a copy of the counts.
    pub(super) fn copy_counts(&mut self, context: &Context, encoder: &mut wgpu::CommandEncoder) {
        let bytes = 4 * self.pixel_count() as u64;
        self.counts_back.copy(context, encoder, &self.counts.buffer, bytes);
    }

    /// Adds what the view's cast found to `outcome`; `index` is the view's among those of the job.
    pub(super) fn add_up(
        &self,
        context: &Context,
        job: &CastJob,
        (index, view): (usize, &ViewJob),
        outcome: &mut CastOutcome,
    ) -> Result<(), DeviceError> {
        outcome.rays += view.ray_count();
        if !job.counts {
            return Ok(());
        }
        let counts: Vec<u32> = self.counts_back.read(context, self.pixel_count())?;
        for &tile in view.tiles.iter() {
            let mut is_missing = false;
            for (x, y) in view.pixels(tile) {
                let count = counts[y as usize * self.raster[0] as usize + x as usize];
                outcome.samples += u64::from(count & !MISSING);
                is_missing |= count & MISSING != 0;
            }
            if is_missing {
                outcome.missing_tiles[index].push(tile);
            }
        }
        Ok(())
    }
}
