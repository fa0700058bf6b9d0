//! Short rays on the GPU.

use super::arena::COLOUR_BYTES;
use super::batch::{Piece, next_pieces};
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use crate::device::{DeviceError, ShortJob};
use layout::{SHORT_RAYS, ViewBlock};
use shaders::compose::KernelRays;
use std::sync::Arc;
use twin::{Lattice, Tiling};

/// Rays that are handed to the driver at a time: what they take must not be too long for it.
const AT_A_TIME: usize = 1 << 14;

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
        let context = Arc::clone(&self.context);
        let key = self.key(KernelRays::Short, job.needs);
        let pipeline = context.kernel(Kernel::Cast(key));
        let of_pieces = || pieces.iter().map(|piece| (&job.views[piece.list], piece.range.clone()));
        let tiling = Tiling { lattice: Lattice::ALL, across: 1, first_pixel: 0 };
        let views: Vec<ViewBlock> = of_pieces().map(|(view, _)| view.rays.block(&tiling)).collect();
        let listed: Vec<[u32; 3]> = (0..)
            .zip(of_pieces())
            .flat_map(|(place, (view, range))| view.short[range].iter().map(move |ray| (place, ray.words())))
            .map(|(place, [pixel, end])| [place, pixel, end])
            .collect();
        let count = listed.len() as u64;
        self.short.grow(&context, count);
        self.short.list(&context, &views, &[listed.len() as u32], &listed);
        self.short_back.begin(&context, COLOUR_BYTES * count);
        let mut encoder = context.new_encoder();
        // What they meet is noted where nobody looks: the whole rays of their pixels have told it.
        let entries = self.entries(key, &self.short, &self.feedback);
        let groups = in_rows((count as u32).div_ceil(SHORT_RAYS));
        note_pass(&context.device, &mut encoder, &pipeline, &entries, groups);
        self.short_back.copy(&mut encoder, &self.short.pixels.stretch(0, COLOUR_BYTES * count));
        context.submit(encoder);
        self.short_back.items(&context)
    }
}
