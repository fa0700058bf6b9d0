//! Short rays on the GPU.

use super::batch::{Piece, next_pieces};
use super::device::GpuDevice;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use super::short::ShortRays;
use super::view::ViewBuffers;
use crate::device::{DeviceError, ShortJob};
use layout::SHORT_RAYS;
use shaders::compose::KernelRays;
use std::sync::Arc;

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
        let ShortRays { buffers, colours_back } = &mut self.short;
        buffers.resize_with(buffers.len().max(pieces.len()), || ViewBuffers::new(&context));
        colours_back.begin(&context, 16 * pieces.iter().map(|piece| piece.range.len() as u64).sum::<u64>());
        let mut encoder = context.new_encoder();
        for (place, Piece { list, range }) in pieces.iter().enumerate() {
            let view = &job.views[*list];
            let short = &view.short[range.clone()];
            self.short.buffers[place].prepare_short(&context, view.rays, short);
            let buffers = &self.short.buffers[place];
            // What they meet is noted where nobody looks: the whole rays of their pixels have told it.
            let bind_group = self.bind(&pipeline, key, buffers, &self.feedback);
            let groups = (short.len() as u32).div_ceil(SHORT_RAYS);
            note_pass(&mut encoder, &pipeline, &bind_group, in_rows(groups));
            let ShortRays { buffers, colours_back } = &mut self.short;
            colours_back.copy(&mut encoder, &buffers[place].pixels.buffer, 16 * short.len() as u64);
        }
        context.submit(encoder);
        self.short.colours_back.items(&context)
    }
}
