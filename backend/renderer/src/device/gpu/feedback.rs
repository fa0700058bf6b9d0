//! The feedback table of a frame on the GPU, and its way to the host.

use super::context::Context;
use super::storage::Storage;
use crate::device::under_way::UnderWay;
use crate::device::{DeviceError, FeedbackTag, TaggedFeedback};
use layout::FeedbackEntry;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// One table that all casts of a frame add to, and the copies of those of earlier frames.
#[derive(Debug)]
pub(super) struct FrameFeedback {
    table: Storage,
    /// Places of the index that the table stands for.
    places: usize,
    /// Whether what the table holds is of an earlier frame, or of another index.
    is_stale: bool,
    copies: UnderWay<TableCopy>,
    /// Host-visible buffers that no copy uses.
    free: Vec<wgpu::Buffer>,
}

/// A table on its way to the host.
#[derive(Debug)]
struct TableCopy {
    buffer: wgpu::Buffer,
    places: usize,
    /// Told once, when the copy can be read or has failed.
    tag: FeedbackTag,
    told: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl FrameFeedback {
    pub(super) fn new(context: &Context) -> Self {
        Self {
            table: Storage::new(context, "feedback of a frame"),
            places: 0,
            is_stale: true,
            copies: UnderWay::default(),
            free: Vec::new(),
        }
    }

    /// The index has other places now: what was gathered says nothing of them.
    pub(super) fn resize(&mut self, context: &Context, places: usize) {
        self.places = places;
        self.table.reserve(context, (places * size_of::<FeedbackEntry>()) as u64);
        self.is_stale = true;
    }

    /// The next table is another frame's.
    pub(super) fn clear(&mut self) {
        self.is_stale = true;
    }

    /// The table that casts add to.
    pub(super) fn table(&self) -> &Storage {
        &self.table
    }

    /// Clears the table where it is stale.
    pub(super) fn clear_stale(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if std::mem::take(&mut self.is_stale) {
            encoder.clear_buffer(&self.table.buffer, 0, None);
        }
    }

    /// Starts the table on its way.
    pub(super) fn end(&mut self, context: &Context, tag: FeedbackTag) {
        let mut encoder = context.new_encoder();
        let bytes = self.table.used_bytes;
        let buffer = self.free_buffer(context, bytes);
        self.clear_stale(&mut encoder);
        encoder.copy_buffer_to_buffer(&self.table.buffer, 0, &buffer, 0, bytes);
        context.submit(encoder);
        let (tell, told) = channel();
        buffer.slice(..bytes).map_async(wgpu::MapMode::Read, move |outcome| {
            // A closed channel means that this table was given up.
            let _ = tell.send(outcome);
        });
        self.copies.start(TableCopy { buffer, places: self.places, tag, told });
    }

    pub(super) fn is_under_way(&self) -> bool {
        !self.copies.is_empty()
    }

    /// A buffer that no copy uses, of at least so many bytes.
    fn free_buffer(&mut self, context: &Context, bytes: u64) -> wgpu::Buffer {
        let found = self.free.iter().position(|buffer| buffer.size() >= bytes);
        if let Some(found) = found {
            return self.free.swap_remove(found);
        }
        // Those that are too small now will be for all larger tables.
        self.free.clear();
        context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("feedback of a frame, read back"),
            size: bytes.next_power_of_two(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// The oldest table, where it has arrived.
    pub(super) fn take(&mut self, context: &Context) -> Result<Option<TaggedFeedback>, DeviceError> {
        let failed = |why: String| {
            DeviceError(format!("{} does not return the feedback of a frame: {why}", context.name))
        };
        let mut outcome = None;
        let arrived = self.copies.take(|copy| match copy.told.try_recv() {
            Err(TryRecvError::Empty) => false,
            Err(TryRecvError::Disconnected) => {
                outcome = Some("it was dropped".to_owned());
                true
            }
            Ok(told) => {
                outcome = told.err().map(|error| error.to_string());
                true
            }
        });
        let Some(TableCopy { buffer, places, tag, .. }) = arrived else { return Ok(None) };
        if let Some(why) = outcome {
            return Err(failed(why));
        }
        let bytes = (places * size_of::<FeedbackEntry>()) as u64;
        let entries = match bytes {
            0 => Vec::new(),
            _ => {
                let mapped = buffer.get_mapped_range(..bytes).map_err(|e| failed(e.to_string()))?;
                bytemuck::pod_collect_to_vec(&mapped)
            }
        };
        buffer.unmap();
        self.free.push(buffer);
        Ok(Some((tag, entries)))
    }
}
