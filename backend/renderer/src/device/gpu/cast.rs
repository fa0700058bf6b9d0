//! Casting whole pictures on the GPU: batches of tiles of any views, of which the next is handed over before the one before
//! is done.

use super::arena::{Arena, Room, tally_bytes};
use super::batch::Piece;
use super::context::Context;
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use super::storage::Storage;
use crate::device::job::{TileGrid, ViewJob};
use crate::device::{CastJob, CastOutcome, DeviceError, Gather, TileList};
use layout::{FeedbackEntry, TALLIED_TILES, TileTally, ViewBlock};
use shaders::compose::{KernelKey, KernelRays};
use std::borrow::Cow;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;
use twin::Tiling;

/// Tiles of some views whose pictures lie in one arena.
#[derive(Default)]
pub(super) struct Listing {
    pub(super) views: Vec<ViewBlock>,
    /// Runs of them, each of a view.
    pub(super) runs: Vec<(u32, Range<u32>)>,
    pub(super) tiles: u32,
}

impl Listing {
    /// Writes it as [`binding::LISTED`](layout::binding::LISTED) says.
    pub(super) fn write(&self, context: &Context, arena: &mut Arena) {
        let mut place = 0;
        let runs = self.runs.iter().map(|(view, run)| {
            let first = place;
            place += run.len() as u32;
            [first, *view, run.start]
        });
        let items: Vec<[u32; 3]> = runs.collect();
        arena.list(context, &self.views, &[self.tiles, items.len() as u32], &items);
    }
}

/// A batch that the device has.
struct UnderWay {
    tiles: usize,
    submission: wgpu::SubmissionIndex,
    started: Instant,
}

impl GpuDevice {
    pub(in crate::device) fn cast(&mut self, job: &CastJob) -> Result<CastOutcome, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        self.upload_scene(job.scene, &job.needs);
        let mut encoder = context.new_encoder();
        match job.gather {
            Gather::Own => encoder.clear_buffer(&self.feedback.buffer, 0, None),
            Gather::Frame => self.frame_feedback.clear_stale(&mut encoder),
        }
        context.submit(encoder);
        if let Some(sharing) = job.sharing.filter(|_| job.mends) {
            return self.mend(job, sharing.fans);
        }
        self.pictures.make_room(&context, job.first_picture, job.views.iter().map(|view| view.raster));
        let views: Vec<(usize, ViewJob)> = job.view_jobs().collect();
        let sharing = job.sharing.filter(|_| job.lattice().step[0] == 1);
        // Of each view, the tiles that were cast and those that are left.
        let done: Vec<[TileList; 2]> = match sharing {
            Some(sharing) => self.cast_planes(job, sharing, &views)?,
            None => {
                let done = self.cast_tiles(job, &views)?;
                let parts = |((_, view), done): (&(usize, ViewJob), usize)| {
                    [view.tiles.part(0..done), view.tiles.part(done..view.tiles.len())]
                };
                views.iter().zip(done).map(parts).collect()
            }
        };
        let mut outcome = CastOutcome::nothing(job);
        let mut cast = Vec::new();
        for ((index, view), [tiles, left]) in views.into_iter().zip(done) {
            outcome.left[index] = left;
            if !tiles.is_empty() {
                cast.push((index, ViewJob { tiles: Cow::Owned(tiles), ..view.clone() }));
            }
        }
        let outcome = self.bring_back(job, &cast, outcome)?;
        match sharing {
            Some(_) if job.counts => self.add_found(&cast, outcome),
            _ => Ok(outcome),
        }
    }

    /// Casts the tiles of some views, batch by batch, until it is asked to leave off. How many it has cast of each.
    fn cast_tiles(&mut self, job: &CastJob, views: &[(usize, ViewJob)]) -> Result<Vec<usize>, DeviceError> {
        let context = Arc::clone(&self.context);
        let key = self.key(KernelRays::OfTiles, job.needs);
        let pipeline = context.kernel(Kernel::Cast(key));
        let lengths: Vec<usize> = views.iter().map(|(_, view)| view.tiles.len()).collect();
        let mut done = vec![0; views.len()];
        let mut under_way: VecDeque<UnderWay> = VecDeque::new();
        let mut last_ended = Instant::now();
        loop {
            while under_way.len() < self.batch.at_once() {
                let pieces = self.batch.next(&lengths, &done);
                if pieces.is_empty() || (job.stop)() {
                    break;
                }
                let started = Instant::now();
                let mut encoder = context.new_encoder();
                let parts = pieces.iter().map(|Piece { list, range }| {
                    let view = &views[*list].1;
                    (view, view.tiles.part(range.clone()))
                });
                self.dispatch(&mut encoder, &pipeline, key, job.gather, &parts.collect::<Vec<_>>());
                pieces.iter().for_each(|piece| done[piece.list] = piece.range.end);
                let tiles = pieces.iter().map(|piece| piece.range.len()).sum();
                under_way.push_back(UnderWay { tiles, submission: context.submit(encoder), started });
            }
            let Some(UnderWay { tiles, submission, started }) = under_way.pop_front() else {
                return Ok(done);
            };
            context.wait_for(submission)?;
            self.batch.learn(tiles, started.max(last_ended).elapsed());
            last_ended = Instant::now();
        }
    }

    /// Notes the cast of some tiles of some views.
    fn dispatch(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        key: KernelKey,
        gather: Gather,
        parts: &[(&ViewJob, TileList)],
    ) {
        for arena in 0..self.pictures.arenas.len() {
            let mut listing = self.listing(arena, parts.iter().map(|(view, tiles)| (*view, tiles)));
            if listing.tiles == 0 {
                continue;
            }
            listing.runs = self.batch.dealt(listing.runs);
            listing.write(&self.context, &mut self.pictures.arenas[arena]);
            let entries = self.entries(key, &self.pictures.arenas[arena], self.feedback_of(gather));
            note_pass(&self.context.device, encoder, pipeline, &entries, in_rows(listing.tiles));
        }
    }

    /// Those of some tiles of views that lie in an arena.
    fn listing<'a>(
        &self,
        arena: usize,
        parts: impl Iterator<Item = (&'a ViewJob<'a>, &'a TileList)>,
    ) -> Listing {
        let mut listing = Listing::default();
        for (view, tiles) in parts {
            if self.lies_in(view, arena) {
                let place = listing.views.len() as u32;
                listing.views.push(self.block_of(view));
                listing.runs.extend(tiles.runs().iter().map(|run| (place, run.clone())));
                listing.tiles += tiles.len() as u32;
            }
        }
        listing
    }

    /// A view as kernels know it.
    pub(super) fn block_of(&self, view: &ViewJob) -> ViewBlock {
        let Room { first, .. } = self.pictures.room(view.picture);
        let TileGrid { lattice, across, .. } = view.grid;
        view.rays.block(&Tiling { lattice, across, first_pixel: first as u32 })
    }

    /// Where a cast's feedback goes.
    pub(super) fn feedback_of(&self, gather: Gather) -> &Storage {
        match gather {
            Gather::Own => &self.feedback,
            Gather::Frame => self.frame_feedback.table(),
        }
    }

    /// Brings back what a cast found: feedback, and a tally of each tile, view by view.
    pub(super) fn bring_back(
        &mut self,
        job: &CastJob,
        cast: &[(usize, ViewJob)],
        mut outcome: CastOutcome,
    ) -> Result<CastOutcome, DeviceError> {
        outcome.rays = cast.iter().map(|(_, view)| view.ray_count()).sum();
        let entries = if job.gather == Gather::Own { self.records.len() } else { 0 };
        let feedback_bytes = (entries * size_of::<FeedbackEntry>()) as u64;
        let context = Arc::clone(&self.context);
        let mut encoder = context.new_encoder();
        let listings = if job.counts { self.listings(cast) } else { Vec::new() };
        let tally_bytes = listings.iter().map(|(_, listing)| tally_bytes(listing.tiles));
        self.found_back.begin(&context, feedback_bytes + tally_bytes.sum::<u64>());
        if entries > 0 {
            self.found_back.copy(&mut encoder, &self.feedback.stretch(0, feedback_bytes));
        }
        for (arena, listing) in &listings {
            // They may have been cast in several batches, and in another order.
            let arena = &mut self.pictures.arenas[*arena];
            listing.write(&context, arena);
            let tallies = arena.tally(&context, &mut encoder, listing.tiles);
            self.found_back.copy(&mut encoder, &tallies);
        }
        context.submit(encoder);
        let tallies: Vec<TileTally> = self.found_back.read(&context, |bytes| {
            let (feedback, tallies) = bytes.split_at(feedback_bytes as usize);
            outcome.feedback = bytemuck::pod_collect_to_vec(feedback);
            bytemuck::pod_collect_to_vec(tallies)
        })?;
        outcome.cut = tallies.iter().map(|tally| u64::from(tally.cut)).sum();
        outcome.samples = tallies.iter().map(|tally| u64::from(tally.samples)).sum();
        let mut tallies = tallies.as_slice();
        for (arena, listing) in &listings {
            let groups = listing.tiles.div_ceil(TALLIED_TILES) as usize;
            let of_arena = tallies.split_off(..groups).expect("there is one for each group");
            if of_arena.iter().any(|tally| tally.missing != [0; 2]) {
                let in_arena = cast.iter().filter(|(_, view)| self.lies_in(view, *arena));
                let tiles = in_arena.flat_map(|(index, view)| view.tiles.iter().map(|tile| (*index, tile)));
                for (place, (index, tile)) in tiles.enumerate() {
                    let all = TALLIED_TILES as usize;
                    if of_arena[place / all].is_missing(place % all) {
                        outcome.missing_tiles[index].push(tile);
                    }
                }
            }
        }
        Ok(outcome)
    }

    /// All that was cast, arena by arena.
    fn listings(&self, cast: &[(usize, ViewJob)]) -> Vec<(usize, Listing)> {
        let arenas = 0..self.pictures.arenas.len();
        let parts = || cast.iter().map(|(_, view)| (view, &*view.tiles));
        let listings = arenas.map(|arena| (arena, self.listing(arena, parts())));
        listings.filter(|(_, listing)| listing.tiles > 0).collect()
    }

    pub(super) fn lies_in(&self, view: &ViewJob, arena: usize) -> bool {
        self.pictures.room(view.picture).arena == arena
    }
}
