//! Casting whole pictures on the GPU: batches of tiles of any views, of which the next is handed over before the one before
//! is done.

use super::arena::Room;
use super::batch::Piece;
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use crate::device::job::{TileGrid, ViewJob};
use crate::device::{CastJob, CastOutcome, DeviceError, Gather};
use layout::{FeedbackEntry, MISSING, ViewBlock};
use shaders::compose::{KernelKey, KernelRays};
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;
use twin::Tiling;

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
        self.pictures.make_room(&context, job.first_picture, job.views.iter().map(|view| view.raster));
        self.upload_scene(job.scene, &job.needs);
        let mut encoder = context.new_encoder();
        match job.gather {
            Gather::Own => encoder.clear_buffer(&self.feedback.buffer, 0, None),
            Gather::Frame => self.frame_feedback.clear_stale(&mut encoder),
        }
        context.submit(encoder);
        let views: Vec<(usize, ViewJob)> = job.view_jobs().collect();
        let done = self.cast_tiles(job, &views)?;
        let mut outcome = CastOutcome::nothing(job);
        let mut cast = Vec::new();
        for ((index, view), done) in views.into_iter().zip(done) {
            let (tiles, left) = view.tiles.split_at(done);
            outcome.left[index] = left.to_vec();
            if done > 0 {
                cast.push((index, ViewJob { tiles: tiles.to_vec().into(), ..view.clone() }));
            }
        }
        self.bring_back(job, &cast, outcome)
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
                let parts = pieces.iter().map(|Piece { list, range }| (&views[*list].1, range.clone()));
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
        parts: &[(&ViewJob, Range<usize>)],
    ) {
        for arena in 0..self.pictures.arenas.len() {
            let (views, tiles) = self.listed(arena, parts);
            if tiles.is_empty() {
                continue;
            }
            self.pictures.arenas[arena].list(&self.context, &views, &self.batch.dealt(&tiles));
            let feedback = match gather {
                Gather::Own => &self.feedback,
                Gather::Frame => self.frame_feedback.table(),
            };
            let bind_group = self.bind(pipeline, key, &self.pictures.arenas[arena], feedback);
            note_pass(encoder, pipeline, &bind_group, in_rows(tiles.len() as u32));
        }
    }

    /// Those of some tiles of views that lie in an arena, each with the place of its view's block.
    fn listed(&self, arena: usize, parts: &[(&ViewJob, Range<usize>)]) -> (Vec<ViewBlock>, Vec<[u32; 2]>) {
        let (mut views, mut tiles) = (Vec::new(), Vec::new());
        for (view, range) in parts {
            let Room { arena: lies_in, first, .. } = self.pictures.room(view.picture);
            if lies_in == arena {
                let TileGrid { lattice, across, .. } = view.grid;
                let place = views.len() as u32;
                views.push(view.rays.block(&Tiling { lattice, across, first_pixel: first as u32 }));
                tiles.extend(view.tiles[range.clone()].iter().map(|&tile| [place, tile]));
            }
        }
        (views, tiles)
    }

    /// Brings back what a cast found: feedback, and a tally of each tile, view by view.
    fn bring_back(
        &mut self,
        job: &CastJob,
        cast: &[(usize, ViewJob)],
        mut outcome: CastOutcome,
    ) -> Result<CastOutcome, DeviceError> {
        outcome.rays = cast.iter().map(|(_, view)| view.ray_count()).sum();
        let entries = if job.gather == Gather::Own { self.places } else { 0 };
        let feedback_bytes = (entries * size_of::<FeedbackEntry>()) as u64;
        // Arena by arena, as they are tallied.
        let mut tallied = if job.counts { cast.iter().collect() } else { Vec::new() };
        tallied.sort_by_key(|(_, view)| self.pictures.room(view.picture).arena);
        let context = Arc::clone(&self.context);
        let mut encoder = context.new_encoder();
        let tiles: usize = tallied.iter().map(|(_, view)| view.tiles.len()).sum();
        self.found_back.begin(&context, feedback_bytes + 4 * tiles as u64);
        if entries > 0 {
            self.found_back.copy(&mut encoder, &self.feedback.stretch(0, feedback_bytes));
        }
        let parts: Vec<_> = tallied.iter().map(|(_, view)| (view, 0..view.tiles.len())).collect();
        for arena in 0..self.pictures.arenas.len() {
            // They may have been cast in several batches, and in another order.
            let (views, tiles) = self.listed(arena, &parts);
            if !tiles.is_empty() {
                let arena = &mut self.pictures.arenas[arena];
                arena.list(&context, &views, &tiles);
                let tallies = arena.tally(&context, &mut encoder, tiles.len() as u32);
                self.found_back.copy(&mut encoder, &tallies);
            }
        }
        context.submit(encoder);
        self.found_back.read(&context, |bytes| {
            let (feedback, tallies) = bytes.split_at(feedback_bytes as usize);
            outcome.feedback = bytemuck::pod_collect_to_vec(feedback);
            let mut tallies = tallies.chunks_exact(4).map(bytemuck::pod_read_unaligned::<u32>);
            for (index, view) in &tallied {
                for (&tile, tally) in view.tiles.iter().zip(&mut tallies) {
                    outcome.samples += u64::from(tally & !MISSING);
                    if tally & MISSING != 0 {
                        outcome.missing_tiles[*index].push(tile);
                    }
                }
            }
        })?;
        Ok(outcome)
    }
}
