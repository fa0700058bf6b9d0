//! What a frame has cost so far.

use protocol::Stages;
use std::time::Instant;

/// What a frame has cost so far.
#[derive(Debug)]
pub(super) struct Account {
    pub(super) started: Instant,
    pub(super) stages: Stages,
    /// Rays cast, repeated ones counted again.
    pub(super) rays: u64,
    /// Samples along them.
    pub(super) samples: u64,
    /// Rays that a GPU's driver left before their end.
    pub(super) cut: u64,
    /// Rays that are final.
    pub(super) done: u64,
    /// Rays of the frame.
    pub(super) total: u64,
    pub(super) bricks_loaded: u64,
    pub(super) bytes_loaded: u64,
}

impl Account {
    pub(super) fn new(total: u64) -> Self {
        Self {
            started: Instant::now(),
            stages: Stages::default(),
            rays: 0,
            samples: 0,
            cut: 0,
            done: 0,
            total,
            bricks_loaded: 0,
            bytes_loaded: 0,
        }
    }
}

pub(super) fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
