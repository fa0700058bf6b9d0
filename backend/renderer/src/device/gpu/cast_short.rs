//! Short rays on the GPU.

use super::arena::COLOUR_BYTES;
use super::batch::{Piece, next_pieces};
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use crate::device::{DeviceError, Gather, ShortJob, ShortView};
use layout::{SHORT_RAYS, ViewBlock};
use needs::Needs;
use shaders::compose::KernelRays;
use std::ops::Range;
use std::sync::Arc;
use twin::{Lattice, Tiling};

/// Rays that are handed to the driver at a time: what they take must not be too long for it.
pub(super) const AT_A_TIME: usize = 1 << 14;

impl GpuDevice {
    /// The colours of short rays of some views, in their order.
    pub(in crate::device) fn cast_short(
        &mut self,
        job: &ShortJob,
    ) -> Result<Vec<Vec<[f32; 4]>>, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        self.upload_scene(job.scene, &job.needs);
        let lengths: Vec<usize> = job.views.iter().map(|view| view.short.len()).collect();
        let mut done = vec![0; lengths.len()];
        let mut colours = vec![Vec::new(); lengths.len()];
        loop {
            let pieces = next_pieces(&lengths, &done, AT_A_TIME);
            if pieces.is_empty() {
                return Ok(colours);
            }
            let mut found = self.cast_some(job, &pieces)?.into_iter();
            for Piece { list, range } in pieces {
                colours[list].extend(found.by_ref().take(range.len()));
                done[list] = range.end;
            }
        }
    }

    fn cast_some(&mut self, job: &ShortJob, pieces: &[Piece]) -> Result<Vec<[f32; 4]>, DeviceError> {
        let lists: Vec<(&ShortView, Range<usize>)> =
            pieces.iter().map(|piece| (&job.views[piece.list], piece.range.clone())).collect();
        // What they meet is noted where nobody looks: the whole rays of their pixels have told it.
        let (colours, _) = self.cast_listed(job.needs, &lists, Gather::Own)?;
        Ok(colours)
    }

    /// The colours of some rays of lists, and the samples of each with [`MISSING`](layout::MISSING) and [`CUT`](layout::CUT);
    /// the scene has been uploaded.
    pub(super) fn cast_listed(
        &mut self,
        needs: Needs,
        lists: &[(&ShortView, Range<usize>)],
        gather: Gather,
    ) -> Result<(Vec<[f32; 4]>, Vec<u32>), DeviceError> {
        let context = Arc::clone(&self.context);
        let key = self.key(KernelRays::Short, needs);
        let pipeline = context.kernel(Kernel::Cast(key));
        let tiling = Tiling { lattice: Lattice::ALL, across: 1, first_pixel: 0 };
        let views: Vec<ViewBlock> = lists.iter().map(|(view, _)| view.rays.block(&tiling)).collect();
        let listed: Vec<[u32; 3]> = (0..)
            .zip(lists)
            .flat_map(|(place, (view, range))| {
                view.short[range.clone()].iter().map(move |ray| (place, ray.words()))
            })
            .map(|(place, [pixel, end])| [place, pixel, end])
            .collect();
        let count = listed.len() as u64;
        if count == 0 {
            return Ok((Vec::new(), Vec::new()));
        }
        self.short.grow(&context, count);
        self.short.list(&context, &views, &[listed.len() as u32], &listed);
        let (colour_bytes, count_bytes) = (COLOUR_BYTES * count, size_of::<u32>() as u64 * count);
        self.short_back.begin(&context, colour_bytes + count_bytes);
        let mut encoder = context.new_encoder();
        let entries = self.entries(key, &self.short, self.feedback_of(gather));
        let groups = in_rows((count as u32).div_ceil(SHORT_RAYS));
        note_pass(&context.device, &mut encoder, &pipeline, &entries, groups);
        self.short_back.copy(&mut encoder, &self.short.pixels.stretch(0, colour_bytes));
        self.short_back.copy(&mut encoder, &self.short.counts.stretch(0, count_bytes));
        context.submit(encoder);
        self.short_back.read(&context, |bytes| {
            let (colours, counts) = bytes.split_at(colour_bytes as usize);
            (bytemuck::pod_collect_to_vec(colours), bytemuck::pod_collect_to_vec(counts))
        })
    }
}
