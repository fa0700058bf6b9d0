//! Buffers that kernels read and write.

use super::context::Context;
use bytemuck::Pod;

/// A storage buffer that grows to what is put into it.
#[derive(Debug)]
pub(super) struct Storage {
    pub(super) buffer: wgpu::Buffer,
    label: &'static str,
    pub(super) used_bytes: u64,
}

impl Storage {
    pub(super) fn new(context: &Context, label: &'static str) -> Self {
        Self { buffer: Self::make(context, label, 64), label, used_bytes: 64 }
    }

    fn make(context: &Context, label: &str, size: u64) -> wgpu::Buffer {
        context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Makes room for `bytes`; what was there may be gone.
    pub(super) fn reserve(&mut self, context: &Context, bytes: u64) {
        self.used_bytes = bytes.max(64).next_multiple_of(16);
        if self.buffer.size() < self.used_bytes {
            self.buffer = Self::make(context, self.label, self.used_bytes.next_power_of_two());
        }
    }

    pub(super) fn write<T: Pod>(&mut self, context: &Context, items: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        self.reserve(context, bytes.len() as u64);
        context.queue.write_buffer(&self.buffer, 0, bytes);
    }

    /// The same, where there is anything to write.
    pub(super) fn write_if_any<T: Pod>(&mut self, context: &Context, items: &[T]) {
        if !items.is_empty() {
            self.write(context, items);
        }
    }

    pub(super) fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.buffer,
            offset: 0,
            size: std::num::NonZeroU64::new(self.used_bytes),
        })
    }
}

/// A uniform buffer for one T.
pub(super) fn uniform<T>(context: &Context, label: &str) -> wgpu::Buffer {
    context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
