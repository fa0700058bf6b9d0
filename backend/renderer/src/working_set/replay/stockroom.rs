//! A replay's bricks: a disk in simulated time, asked in the policy's order.

use super::disk::Disk;
use super::policy::{Policy, Waiting};
use crate::working_set::{Arrival, Supply, WorkingSet};
use bricks::NodeKey;
use std::collections::HashSet;
use std::time::{Duration, Instant};

/// A disk, and what came from it.
pub(super) struct Stockroom {
    disk: Disk,
    waiting: Waiting,
    policy: Policy,
    now_s: f64,
    /// Bricks that were in the cache at any time.
    known: HashSet<NodeKey>,
    /// Bricks that came into the cache in this frame.
    pub(super) loaded: u64,
    /// Those among them that had been there before.
    pub(super) loaded_again: u64,
    /// Time that this frame's simulation of the disk took.
    pub(super) busy: Duration,
}

impl Stockroom {
    pub(super) fn new(policy: Policy, brick_bytes: u64) -> Self {
        Self {
            disk: Disk::new(policy.disk, brick_bytes),
            waiting: Waiting::default(),
            policy,
            now_s: 0.0,
            known: HashSet::new(),
            loaded: 0,
            loaded_again: 0,
            busy: Duration::ZERO,
        }
    }

    /// Opens for a frame.
    pub(super) fn open(&mut self, now_s: f64) {
        (self.now_s, self.loaded, self.loaded_again, self.busy) = (now_s, 0, 0, Duration::ZERO);
    }

    /// Bricks that the disk has read.
    pub(super) fn bricks_read(&self) -> u64 {
        self.disk.bricks_read
    }
}

impl Supply for Stockroom {
    fn want(&mut self, set: &WorkingSet, ahead: &[NodeKey]) {
        let started = Instant::now();
        let wanted = self.waiting.ordered(self.policy.order, set);
        self.disk.run_until(self.now_s);
        self.disk.want(&wanted, ahead);
        self.disk.run_until(self.now_s);
        self.busy += started.elapsed();
    }

    fn deliver(&mut self, set: &mut WorkingSet) {
        let started = Instant::now();
        for key in self.disk.arrived(self.policy.upload_bytes) {
            if let Arrival::Slot(_) = set.arrived(key, 0.0, 0.0) {
                self.loaded += 1;
                self.loaded_again += u64::from(!self.known.insert(key));
            }
        }
        self.busy += started.elapsed();
    }
}
