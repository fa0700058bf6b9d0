//! Casting whole pictures on the GPU: batches of tiles of any views, of which the next is handed over before the one before
//! is done.

use super::batch::Piece;
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use crate::device::job::ViewJob;
use crate::device::{CastJob, CastOutcome, DeviceError, Gather};
use layout::{FeedbackEntry, MISSING};
use shaders::compose::{KernelKey, KernelRays};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

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
        self.pictures.make_room(&context, job.first_picture + job.views.len());
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
                for Piece { list, range } in &pieces {
                    let view = &views[*list].1;
                    let tiles = self.batch.dealt(&view.tiles[range.clone()]).into();
                    self.dispatch(&mut encoder, &pipeline, key, job, &ViewJob { tiles, ..view.clone() });
                    done[*list] = range.end;
                }
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

    /// Notes the cast of one view.
    fn dispatch(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        key: KernelKey,
        job: &CastJob,
        view: &ViewJob,
    ) {
        self.pictures.views[view.picture].prepare(&self.context, view);
        let feedback = match job.gather {
            Gather::Own => &self.feedback,
            Gather::Frame => self.frame_feedback.table(),
        };
        let bind_group = self.bind(pipeline, key, &self.pictures.views[view.picture], feedback);
        note_pass(encoder, pipeline, &bind_group, in_rows(view.tiles.len() as u32));
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
        let tallied = if job.counts { cast } else { &[] };
        let feedback_bytes = (entries * size_of::<FeedbackEntry>()) as u64;
        let tiles: usize = tallied.iter().map(|(_, view)| view.tiles.len()).sum();
        let Self { context, found_back, feedback, pictures, .. } = self;
        let mut encoder = context.new_encoder();
        found_back.begin(context, feedback_bytes + 4 * tiles as u64);
        if entries > 0 {
            found_back.copy(&mut encoder, &feedback.buffer, feedback_bytes);
        }
        for (_, view) in tallied {
            let tallies = pictures.views[view.picture].tally(context, &mut encoder, view);
            found_back.copy(&mut encoder, tallies, 4 * view.tiles.len() as u64);
        }
        context.submit(encoder);
        found_back.read(context, |bytes| {
            let (feedback, tallies) = bytes.split_at(feedback_bytes as usize);
            outcome.feedback = bytemuck::pod_collect_to_vec(feedback);
            let mut tallies = tallies.chunks_exact(4).map(bytemuck::pod_read_unaligned::<u32>);
            for (index, view) in tallied {
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
