//! What the GPU keeps of one view: its rays and tiles, its picture and its counts.

use super::context::Context;
use super::kernels::Kernel;
use super::pass::note_pass;
use super::storage::{Storage, uniform};
use crate::device::job::ViewJob;
use layout::{TALLIED_TILES, ViewBlock, binding};
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
    /// Whether any of that is behind them.
    pub(super) behind: Storage,
    pub(super) counts: Storage,
    /// Those of a cast's tiles, added up.
    tallies: Storage,
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
            behind: storage("whether a picture is behind"),
            counts: storage("sample counts"),
            tallies: storage("sample counts of tiles"),
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

    /// Notes that the counts of a cast's tiles are added up. What will hold a word for each.
    pub(super) fn tally(
        &mut self,
        context: &Context,
        encoder: &mut wgpu::CommandEncoder,
        view: &ViewJob,
    ) -> &wgpu::Buffer {
        // They may have been cast in several batches.
        self.prepare(context, view);
        let tiles = view.tiles.len() as u32;
        self.tallies.reserve(context, 4 * u64::from(tiles));
        let pipeline = context.kernel(Kernel::Tally);
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let bind_group = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                entry(binding::VIEW, self.block.as_entire_binding()),
                entry(binding::TILES, self.tiles.binding()),
                entry(binding::COUNTS, self.counts.binding()),
                entry(binding::TALLIES, self.tallies.binding()),
            ],
        });
        note_pass(encoder, &pipeline, &bind_group, [tiles.div_ceil(TALLIED_TILES), 1]);
        &self.tallies.buffer
    }
}
