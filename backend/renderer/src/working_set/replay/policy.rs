//! What a replay tries: a cache, a disk, and what is fetched first.

use crate::cache_size::slots_within;
use crate::working_set::{SAMPLE_BYTES, WorkingSet};
use bricks::{NodeKey, OctreeShape};
use std::cmp::Reverse;
use std::collections::HashMap;

/// What is fetched first of all that is wanted. What is wanted is the same by every order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FetchOrder {
    /// The largest deficit, then the most rays: what the renderer does.
    #[default]
    Deficit,
    /// The most rays alone.
    Rays,
    /// First come, first served: what has been wanted for longest without a break.
    Arrival,
}

/// How fast bricks come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskModel {
    /// Bytes per second of all reads together; may be ∞.
    pub bytes_per_s: f64,
    /// From the beginning of a read to its first byte, seconds.
    pub latency_s: f64,
    /// Reads at a time; their latencies overlap.
    pub threads: usize,
}

/// What is tried on a trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Policy {
    /// Size of the brick cache, bytes.
    pub cache_bytes: u64,
    /// Bytes of bricks that a frame may move to the device.
    pub upload_bytes: u64,
    /// How fast bricks come.
    pub disk: DiskModel,
    /// Time in which detail appears or goes, seconds; 0 is at once.
    pub fade_s: f64,
    /// What is fetched first.
    pub order: FetchOrder,
}

impl Policy {
    /// Bricks that the cache holds, as the CPU renderer's does; a GPU's holds a power of two.
    pub(super) fn slots(&self, shape: &OctreeShape) -> u32 {
        // The renderer keeps one of them blank.
        slots_within(self.cache_bytes, SAMPLE_BYTES, shape.total_node_count()) - 1
    }
}

/// Puts what is wanted in order.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    /// Of each wanted brick: its number in the order of asking.
    numbers: HashMap<NodeKey, u64>,
    next: u64,
}

impl Waiting {
    pub(super) fn ordered(&mut self, order: FetchOrder, set: &WorkingSet) -> Vec<NodeKey> {
        let mut wanted = set.wanted().to_vec();
        match order {
            FetchOrder::Deficit => {}
            FetchOrder::Rays => wanted.sort_by_key(|&key| Reverse(rays_above(set, key))),
            FetchOrder::Arrival => {
                self.number(&wanted);
                wanted.sort_by_key(|key| self.numbers[key]);
            }
        }
        wanted
    }

    fn number(&mut self, wanted: &[NodeKey]) {
        let before = std::mem::take(&mut self.numbers);
        for &key in wanted {
            let number = before.get(&key).copied().unwrap_or(self.next);
            self.next += u64::from(number == self.next);
            self.numbers.insert(key, number);
        }
    }
}

/// Rays that met what a brick is to refine. Nothing can do without the root.
fn rays_above(set: &WorkingSet, key: NodeKey) -> u32 {
    let parent = set.cut().node(set.cut().find(key)).parent;
    parent.map_or(u32::MAX, |parent| set.cut().node(parent).met.rays)
}
