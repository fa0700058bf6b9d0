//! Buffers that kernels read and write.

use super::context::Context;
use bytemuck::Pod;

/// A stretch of a storage buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'a> {
    pub(super) buffer: &'a wgpu::Buffer,
    pub(super) offset: u64,
    pub(super) bytes: u64,
}

impl<'a> Stretch<'a> {
    pub(super) fn binding(&self) -> wgpu::BindingResource<'a> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: self.buffer,
            offset: self.offset,
            size: std::num::NonZeroU64::new(self.bytes),
        })
    }
}

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

    /// Makes room for `bytes` and no more; what was there stays.
    pub(super) fn grow(&mut self, context: &Context, bytes: u64) {
        self.used_bytes = bytes.max(64).next_multiple_of(16);
        if self.buffer.size() < self.used_bytes {
            let larger = Self::make(context, self.label, self.used_bytes);
            let mut encoder = context.new_encoder();
            encoder.copy_buffer_to_buffer(&self.buffer, 0, &larger, 0, self.buffer.size());
            context.submit(encoder);
            self.buffer = larger;
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

    /// A part of it, from `offset` on.
    pub(super) fn stretch(&self, offset: u64, bytes: u64) -> Stretch<'_> {
        Stretch { buffer: &self.buffer, offset, bytes }
    }

    /// All of it that is used.
    pub(super) fn whole(&self) -> Stretch<'_> {
        self.stretch(0, self.used_bytes)
    }

    pub(super) fn binding(&self) -> wgpu::BindingResource<'_> {
        self.whole().binding()
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

/// A buffer under each number.
pub(super) fn entries_of<'a>(
    buffers: impl IntoIterator<Item = (u32, &'a Storage)>,
) -> impl Iterator<Item = wgpu::BindGroupEntry<'a>> {
    buffers
        .into_iter()
        .map(|(binding, storage)| wgpu::BindGroupEntry { binding, resource: storage.binding() })
}
