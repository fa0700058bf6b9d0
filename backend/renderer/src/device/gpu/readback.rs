//! Bringing buffers back to the host.

use super::context::Context;
use super::storage::Stretch;
use crate::device::DeviceError;
use bytemuck::Pod;

/// A host-visible buffer that grows to what is asked of it: what is copied there in one submission lies in a row.
#[derive(Debug)]
pub(super) struct Readback {
    buffer: Option<wgpu::Buffer>,
    used_bytes: u64,
}

impl Readback {
    pub(super) fn new() -> Self {
        Self { buffer: None, used_bytes: 0 }
    }

    /// Makes room for copies of so many bytes in all; what was there is gone.
    pub(super) fn begin(&mut self, context: &Context, bytes: u64) {
        self.used_bytes = 0;
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < bytes) {
            self.buffer = Some(context.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
    }

    /// Notes a copy, behind those that were noted.
    pub(super) fn copy(&mut self, encoder: &mut wgpu::CommandEncoder, from: &Stretch) {
        encoder.copy_buffer_to_buffer(from.buffer, from.offset, self.buffer(), self.used_bytes, from.bytes);
        self.used_bytes += from.bytes;
    }

    /// Waits for the copies, which have been submitted, and hands over their bytes.
    pub(super) fn read<T>(&self, context: &Context, take: impl FnOnce(&[u8]) -> T) -> Result<T, DeviceError> {
        if self.used_bytes == 0 {
            return Ok(take(&[]));
        }
        let slice = self.buffer().slice(..self.used_bytes);
        let (tell, told) = std::sync::mpsc::channel();
        slice.map_async(wgpu::MapMode::Read, move |outcome| {
            // The receiver waits below; a closed channel means it has already given up.
            let _ = tell.send(outcome);
        });
        context.wait()?;
        let failed =
            |why: String| DeviceError(format!("{} does not return its results: {why}", context.name));
        told.recv().map_err(|e| failed(e.to_string()))?.map_err(|e| failed(e.to_string()))?;
        let taken = take(&slice.get_mapped_range().map_err(|e| failed(e.to_string()))?);
        self.buffer().unmap();
        Ok(taken)
    }

    /// The same, as items.
    pub(super) fn items<T: Pod>(&self, context: &Context) -> Result<Vec<T>, DeviceError> {
        self.read(context, bytemuck::pod_collect_to_vec)
    }

    fn buffer(&self) -> &wgpu::Buffer {
        self.buffer.as_ref().expect("room is made before every copy")
    }
}
