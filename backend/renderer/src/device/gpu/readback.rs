//! Bringing buffers back to the host.

use super::context::Context;
use crate::device::DeviceError;
use bytemuck::Pod;

/// A host-visible buffer that grows to what is asked of it.
#[derive(Debug)]
pub(super) struct Readback {
    buffer: Option<wgpu::Buffer>,
}

impl Readback {
    pub(super) fn new() -> Self {
        Self { buffer: None }
    }

    /// Notes a copy of the first `bytes` of `from`; read it once the encoder has run.
    pub(super) fn copy(
        &mut self,
        context: &Context,
        encoder: &mut wgpu::CommandEncoder,
        from: &wgpu::Buffer,
        bytes: u64,
    ) {
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < bytes) {
            self.buffer = Some(context.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let to = self.buffer.as_ref().expect("the buffer was just made");
        encoder.copy_buffer_to_buffer(from, 0, to, 0, bytes);
    }

    /// The first `count` items of what was copied.
    pub(super) fn read<T: Pod>(&self, context: &Context, count: usize) -> Result<Vec<T>, DeviceError> {
        let buffer = self.buffer.as_ref().expect("a copy precedes every read");
        let slice = buffer.slice(..(count * size_of::<T>()) as u64);
        let (tell, told) = std::sync::mpsc::channel();
        slice.map_async(wgpu::MapMode::Read, move |outcome| {
            // The receiver waits below; a closed channel means it has already given up.
            let _ = tell.send(outcome);
        });
        context.wait()?;
        let failed =
            |why: String| DeviceError(format!("{} does not return its results: {why}", context.name));
        told.recv().map_err(|e| failed(e.to_string()))?.map_err(|e| failed(e.to_string()))?;
        let items = {
            let mapped = slice.get_mapped_range().map_err(|e| failed(e.to_string()))?;
            bytemuck::pod_collect_to_vec(&mapped)
        };
        buffer.unmap();
        Ok(items)
    }
}
