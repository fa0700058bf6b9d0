//! A disk in simulated time, behind the queue of the real loader.

use super::DiskModel;
use crate::working_set::loader::Queue;
use crate::working_set::{LoadedBrick, PANTRY_BYTES};
use bricks::NodeKey;

/// A read that has begun.
#[derive(Clone, Copy, Debug)]
struct Read {
    ends_s: f64,
    key: NodeKey,
}

/// Reads bricks without voxels.
#[derive(Debug)]
pub(super) struct Disk {
    model: DiskModel,
    /// Bytes of a brick as the disk holds it.
    brick_bytes: u64,
    queue: Queue,
    /// In the order in which they began.
    reading: Vec<Read>,
    now_s: f64,
    /// Until when the bytes of reads that have begun take all of the bandwidth.
    busy_until_s: f64,
    /// Bricks whose reads have ended.
    pub(super) bricks_read: u64,
}

impl Disk {
    pub(super) fn new(model: DiskModel, brick_bytes: u64) -> Self {
        let model = DiskModel { threads: model.threads.max(1), ..model };
        Self {
            model,
            brick_bytes,
            queue: Queue::new(model.threads, PANTRY_BYTES),
            reading: Vec::new(),
            now_s: f64::NEG_INFINITY,
            busy_until_s: f64::NEG_INFINITY,
            bricks_read: 0,
        }
    }

    pub(super) fn want(&mut self, ordered: &[NodeKey], ahead: &[NodeKey]) {
        self.queue.want(ordered, ahead);
    }

    /// Reads until a moment what was wanted last; what takes no time is there at once.
    pub(super) fn run_until(&mut self, now_s: f64) {
        // Before the first frame nothing was wanted, so nothing can begin before it.
        self.now_s = if self.now_s == f64::NEG_INFINITY { now_s } else { self.now_s };
        loop {
            self.begin();
            let first = (0..self.reading.len())
                .min_by(|&a, &b| self.reading[a].ends_s.total_cmp(&self.reading[b].ends_s));
            let Some(first) = first.filter(|&first| self.reading[first].ends_s <= now_s) else { break };
            let Read { ends_s, key } = self.reading.remove(first);
            self.now_s = self.now_s.max(ends_s);
            self.queue.finish(key, Ok(self.brick()));
            self.bricks_read += 1;
        }
        self.now_s = self.now_s.max(now_s);
    }

    /// What has come and is wanted, first things first.
    pub(super) fn arrived(&mut self, most_bytes: u64) -> impl Iterator<Item = NodeKey> + use<> {
        self.queue.arrived(most_bytes).into_iter().map(|(key, _)| key)
    }

    fn begin(&mut self) {
        while self.reading.len() < self.model.threads {
            let Some(key) = self.queue.begin() else { break };
            let from_s = (self.now_s + self.model.latency_s).max(self.busy_until_s);
            let ends_s = from_s + self.brick_bytes as f64 / self.model.bytes_per_s;
            self.busy_until_s = ends_s;
            self.reading.push(Read { ends_s, key });
        }
    }

    fn brick(&self) -> LoadedBrick {
        LoadedBrick::without_samples(self.brick_bytes)
    }
}
