//! Short rays on the GPU.

use super::device::{GROUPS_ACROSS, GpuDevice};
use super::kernels::Kernel;
use super::short::ShortRays;
use crate::device::{DeviceError, ShortJob};
use layout::SHORT_RAYS;
use shaders::compose::KernelRays;
use std::sync::Arc;
use twin::ShortRay;

/// Rays that are handed to the driver at a time: what they take must not be too long for it.
const AT_A_TIME: usize = 1 << 14;

impl GpuDevice {
    /// The colours of short rays, in their order.
    pub(in crate::device) fn cast_short(&mut self, job: &ShortJob) -> Result<Vec<[f32; 4]>, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        self.upload_scene(job.scene, &job.needs);
        let mut colours = Vec::with_capacity(job.short.len());
        for short in job.short.chunks(AT_A_TIME) {
            colours.extend(self.cast_some(job, short)?);
        }
        Ok(colours)
    }

    fn cast_some(&mut self, job: &ShortJob, short: &[ShortRay]) -> Result<Vec<[f32; 4]>, DeviceError> {
        let context = Arc::clone(&self.context);
        let key = self.key(KernelRays::Short, job.needs);
        let pipeline = context.kernel(Kernel::Cast(key));
        self.short.buffers.prepare_short(&context, job.rays, short);
        // What they meet is noted where nobody looks: the whole rays of their pixels have told it.
        let bind_group = self.bind(&pipeline, key, &self.short.buffers, &self.feedback);
        let mut encoder = context.new_encoder();
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        let groups = (short.len() as u32).div_ceil(SHORT_RAYS);
        pass.dispatch_workgroups(groups.min(GROUPS_ACROSS), groups.div_ceil(GROUPS_ACROSS), 1);
        drop(pass);
        let ShortRays { buffers, colours_back } = &mut self.short;
        colours_back.copy(&context, &mut encoder, &buffers.pixels.buffer, 16 * short.len() as u64);
        context.run(encoder)?;
        colours_back.read(&context, short.len())
    }
}
