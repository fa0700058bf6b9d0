//! Row planes on the GPU: rows of tiles of all views of a fan, slab after slab from the front to the back. What some view still
//! sees of a slab is sampled once, and all views sweep it; what is too steep for that each ray samples itself.

use super::bands::{Band, BandSlab, Slice};
use super::cast::Listing;
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use super::plane_buffers::bytes_of_column;
use crate::device::job::ViewJob;
use crate::device::{CastJob, CastOutcome, DeviceError, Sharing, TileList};
use layout::{FanBlock, PLANE_COLUMNS, PlaneFound, PlaneLayer, TILE_EDGE};
use needs::{Compositing, Needs};
use optics::Enhancer;
use planes::{Fan, Plan};
use shaders::compose::{KernelRays, PlaneStep};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// Columns that are kept at a time, at most; of these a batch takes as many bands as fit.
const MOST_COLUMNS: usize = 1 << 22;
/// The same for a driver in software: a row of tiles of many views takes it seconds, and whoever asks it to leave off waits.
const MOST_COLUMNS_OF_SOFTWARE: usize = 1 << 19;
/// Sweeps that the driver has at once, besides the one that is waited for.
const AT_ONCE: usize = 1;

/// Storage buffers of the kernel that sweeps planes.
fn storage_buffers(needs: &Needs) -> u32 {
    let tables = 2 * u32::from(needs.reads_importance()) + u32::from(needs.has_materials);
    15 + tables + u32::from(needs.compositing != Compositing::Over)
}

impl GpuDevice {
    /// Why it cannot cast them for a scene with these needs.
    pub(in crate::device) fn refuses_planes(&self, needs: &Needs) -> Option<&'static str> {
        let most = self.context.device.limits().max_storage_buffers_per_shader_stage;
        (most < storage_buffers(needs)).then_some("the GPU binds too few storage buffers at a time")
    }

    /// Casts the tiles of some views by planes, fan by fan. Of each view, those that were cast and those that are left.
    pub(super) fn cast_planes(
        &mut self,
        job: &CastJob,
        sharing: Sharing,
        views: &[(usize, ViewJob)],
    ) -> Result<Vec<[TileList; 2]>, DeviceError> {
        let context = Arc::clone(&self.context);
        let rows_of_tiles = views.iter().map(|(_, view)| view.grid.down).max().unwrap_or(0);
        self.planes.found.reserve(&context, u64::from(rows_of_tiles) * size_of::<PlaneFound>() as u64);
        let mut encoder = context.new_encoder();
        encoder.clear_buffer(&self.planes.found.buffer, 0, None);
        context.submit(encoder);
        let mut cast = vec![[TileList::default(), TileList::default()]; views.len()];
        for fan in sharing.fans.iter() {
            let of_fan: Vec<usize> =
                (0..views.len()).filter(|&place| fan.views.contains(&views[place].0)).collect();
            let jobs: Vec<(usize, &ViewJob)> =
                of_fan.iter().map(|&place| (views[place].0, &views[place].1)).collect();
            let rows = self.cast_fan(job, (fan, sharing.enhancers), &jobs)?;
            for place in of_fan {
                let view = &views[place].1;
                for tile in view.tiles.iter() {
                    let is_left = !rows.contains(&(tile / view.grid.across));
                    cast[place][usize::from(is_left)].push(tile);
                }
            }
        }
        Ok(cast)
    }

    /// The rows of tiles that were cast, until it was asked to leave off.
    fn cast_fan(
        &mut self,
        job: &CastJob,
        (fan, enhancers): (&Fan, &[Enhancer]),
        views: &[(usize, &ViewJob)],
    ) -> Result<BTreeSet<u32>, DeviceError> {
        let context = Arc::clone(&self.context);
        let lattice = job.lattice();
        let rows_of_band = TILE_EDGE * lattice.step[1];
        let room = (context.most_bound_bytes() / bytes_of_column(&job.needs)) as usize;
        let most = if context.is_software { MOST_COLUMNS_OF_SOFTWARE } else { MOST_COLUMNS }.min(room);
        let nodes = Arc::clone(&self.records);
        let plan = Plan::new(job.scene, &nodes, fan, enhancers);
        let asked: BTreeSet<u32> = views.iter().flat_map(|(_, view)| view.rows_of_tiles()).collect();
        let band = |at: u32| {
            let above = at * rows_of_band;
            let rows = above..(above + rows_of_band).min(fan.raster[1]);
            let slab = |layers: Vec<PlaneLayer>| {
                let front = layers.first().filter(|_| job.needs.is_by_pixel());
                BandSlab { factors: front.map_or_else(Vec::new, |front| plan.factors(&rows, front)), layers }
            };
            Band::new(at, plan.layers(&rows).into_iter().map(slab).collect(), room)
        };
        let mut bands = asked.iter().map(|&at| band(at)).peekable();
        let mut under_way = VecDeque::new();
        let mut cast = BTreeSet::new();
        let mut is_stopped = false;
        while bands.peek().is_some() && !is_stopped && !(job.stop)() {
            let (mut batch, mut columns) = (Vec::new(), 0);
            while let Some(band) =
                bands.next_if(|band| batch.is_empty() || columns + band.most_columns() <= most)
            {
                columns += band.most_columns();
                batch.push(band);
            }
            let rows: BTreeSet<u32> = batch.iter().map(|band| band.at).collect();
            let listed = self.list_rows(fan, views, &rows);
            let sweeps = batch.iter().map(Band::sweeps).max().unwrap_or(0);
            for number in 0..sweeps.max(1) {
                is_stopped = number > 0 && (job.stop)();
                if is_stopped {
                    break;
                }
                let block =
                    FanBlock { sweeps: number as u32, bands: batch.len() as u32, ..plan.block(&lattice) };
                let slice = Slice::of(&batch, number);
                under_way.push_back(self.sweep_slice(job, (fan, &block), &listed, &slice)?);
                if under_way.len() > AT_ONCE
                    && let Some(submission) = under_way.pop_front()
                {
                    context.wait_for(submission)?;
                }
            }
            if !is_stopped {
                cast.extend(rows);
            }
        }
        under_way.into_iter().try_for_each(|submission| context.wait_for(submission))?;
        Ok(cast)
    }

    /// Lists the tiles of some rows in the arenas where they lie: each of these, and how many they are.
    fn list_rows(
        &mut self,
        fan: &Fan,
        views: &[(usize, &ViewJob)],
        rows: &BTreeSet<u32>,
    ) -> Vec<(usize, u32)> {
        let mut listed = Vec::new();
        for arena in 0..self.pictures.arenas.len() {
            let listing = self.listing_of_rows(arena, fan, views, rows);
            if listing.tiles > 0 {
                listing.write(&self.context, &mut self.pictures.arenas[arena]);
                listed.push((arena, listing.tiles));
            }
        }
        listed
    }

    /// Samples some slabs of some bands, and takes all views through them.
    fn sweep_slice(
        &mut self,
        job: &CastJob,
        (fan, block): (&Fan, &FanBlock),
        listed: &[(usize, u32)],
        slice: &Slice,
    ) -> Result<wgpu::SubmissionIndex, DeviceError> {
        let context = Arc::clone(&self.context);
        if bytes_of_column(&job.needs) * slice.columns as u64 > context.most_bound_bytes() {
            let why =
                "a slab of the row planes has more columns than the GPU binds at a time; take --caster rays";
            return Err(DeviceError(why.into()));
        }
        self.planes.prepare(&context, &job.needs, (fan, block), slice);
        let mut encoder = context.new_encoder();
        if block.sweeps == 0 {
            encoder.clear_buffer(&self.planes.open.buffer, 0, None);
        }
        let groups =
            [slice.widest.div_ceil(PLANE_COLUMNS), slice.deepest, TILE_EDGE * slice.bands.len() as u32];
        if slice.columns > 0 {
            let steps = [PlaneStep::Fill, PlaneStep::Means, PlaneStep::Errors];
            let has_means = !job.needs.is_by_pixel();
            for step in steps.into_iter().filter(|&step| has_means || step != PlaneStep::Means) {
                self.note_step(&mut encoder, job, step, groups);
            }
        }
        let key = self.key(KernelRays::OfPlanes(PlaneStep::Sweep), job.needs);
        let pipeline = context.kernel(Kernel::Cast(key));
        for &(arena, tiles) in listed {
            let mut entries = self.entries(key, &self.pictures.arenas[arena], self.feedback_of(job.gather));
            entries.extend(self.planes.entries(PlaneStep::Sweep, &job.needs));
            note_pass(&context.device, &mut encoder, &pipeline, &entries, in_rows(tiles));
        }
        Ok(context.submit(encoder))
    }

    fn note_step(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        job: &CastJob,
        step: PlaneStep,
        groups: [u32; 3],
    ) {
        let key = self.key(KernelRays::OfPlanes(step), job.needs);
        let pipeline = self.context.kernel(Kernel::Cast(key));
        let mut entries = match step {
            PlaneStep::Fill => self.entries_of_volume(key, self.feedback_of(job.gather)),
            PlaneStep::Errors if job.needs.is_by_pixel() => self.entries_of_cells(),
            _ => self.entries_of_tables(),
        };
        entries.extend(self.planes.entries(step, &job.needs));
        note_pass(&self.context.device, encoder, &pipeline, &entries, groups);
    }

    /// The tiles of some rows, of the views whose pictures lie in an arena. All views are listed, in the order of the fan.
    fn listing_of_rows(
        &self,
        arena: usize,
        fan: &Fan,
        views: &[(usize, &ViewJob)],
        rows: &BTreeSet<u32>,
    ) -> Listing {
        let mut listing = Listing::default();
        for (place, view) in fan.views.iter().enumerate() {
            let Some((_, view)) = views.iter().find(|(known, _)| known == view) else {
                // Nothing of it is cast.
                listing.views.push(bytemuck::Zeroable::zeroed());
                continue;
            };
            listing.views.push(self.block_of(view));
            if !self.lies_in(view, arena) {
                continue;
            }
            let is_in = |tile: &u32| rows.contains(&(tile / view.grid.across));
            let tiles: TileList = view.tiles.iter().filter(is_in).collect();
            listing.runs.extend(tiles.runs().iter().map(|run| (place as u32, run.clone())));
            listing.tiles += tiles.len() as u32;
        }
        listing
    }

    /// Adds what planes found to what rays did: of a row of tiles that met a node that is too coarse, all tiles are missing it.
    pub(super) fn add_found(
        &mut self,
        cast: &[(usize, ViewJob)],
        mut outcome: CastOutcome,
    ) -> Result<CastOutcome, DeviceError> {
        let context = Arc::clone(&self.context);
        let bytes = self.planes.found.used_bytes;
        let mut encoder = context.new_encoder();
        self.found_back.begin(&context, bytes);
        self.found_back.copy(&mut encoder, &self.planes.found.whole());
        context.submit(encoder);
        let found: Vec<PlaneFound> = self.found_back.read(&context, bytemuck::pod_collect_to_vec)?;
        outcome.samples += found.iter().map(|row| u64::from(row.samples)).sum::<u64>();
        for (index, view) in cast {
            let missing = &mut outcome.missing_tiles[*index];
            let is_missing = |tile: u32| found[(tile / view.grid.across) as usize].is_missing != 0;
            let of_rays: BTreeSet<u32> = missing.iter().collect();
            *missing =
                view.tiles.iter().filter(|&tile| is_missing(tile) || of_rays.contains(&tile)).collect();
        }
        Ok(outcome)
    }
}
