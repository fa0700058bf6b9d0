//! The bricks that could not be read: which, why, and which of them the current frame missed.

use bricks::{BrickError, NodeKey};
use std::collections::{BTreeMap, BTreeSet};

/// What a run has learned of unreadable bricks. A brick is asked for once: what failed is not asked for again, because
/// the rays of every frame would.
#[derive(Debug, Default)]
pub(super) struct Damage {
    known: BTreeMap<NodeKey, BrickError>,
    missed: BTreeSet<NodeKey>,
}

impl Damage {
    /// A new frame has missed nothing yet.
    pub(super) fn start_frame(&mut self) {
        self.missed.clear();
    }

    /// Notes that a brick cannot be read, and says so in the log, once.
    pub(super) fn learn(&mut self, node: NodeKey, error: BrickError) {
        tracing::warn!("{error}");
        self.known.insert(node, error);
    }

    /// A brick that could not be read has come after all.
    pub(super) fn forget(&mut self, node: NodeKey) {
        self.known.remove(&node);
    }

    /// Why a node's brick cannot be read; None if nothing is known against it.
    pub(super) fn of(&self, node: NodeKey) -> Option<&BrickError> {
        self.known.get(&node)
    }

    /// Notes what the frame misses of some nodes that its rays ask for; returns whether it misses any.
    pub(super) fn note_missed(&mut self, nodes: &[NodeKey]) -> bool {
        let unreadable: Vec<NodeKey> =
            nodes.iter().copied().filter(|node| self.known.contains_key(node)).collect();
        self.missed.extend(&unreadable);
        !unreadable.is_empty()
    }

    /// Bricks that the frame missed.
    pub(super) fn missed(&self) -> u64 {
        self.missed.len() as u64
    }

    /// A sentence for each of the first `most` that the frame missed, coarse ones first.
    pub(super) fn sentences(&self, most: usize) -> Vec<String> {
        let errors = self.missed.iter().filter_map(|node| self.known.get(node));
        errors.take(most).map(ToString::to_string).collect()
    }
}
