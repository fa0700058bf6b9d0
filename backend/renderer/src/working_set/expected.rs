//! What a working set takes the place of: bricks that another one showed are asked for before rays find them missing.

use super::{Cut, Feedback};
use bricks::NodeKey;

/// After so long, what has not come is left to rays: the view is another one by then.
const PATIENCE_S: f64 = 5.0;

/// Nodes that another working set of the same volume showed, and that this one lacks.
#[derive(Clone, Debug, Default)]
pub(super) struct Expected {
    /// From the root down.
    nodes: Vec<NodeKey>,
    until_s: Option<f64>,
}

impl Expected {
    pub(super) fn new(mut nodes: Vec<NodeKey>) -> Self {
        nodes.sort_unstable();
        Self { nodes, until_s: None }
    }

    /// Drops what has come, or all once it is too late.
    pub(super) fn update(&mut self, cut: &Cut, now_s: f64) {
        if self.nodes.is_empty() {
            return;
        }
        if now_s > *self.until_s.get_or_insert(now_s + PATIENCE_S) {
            self.nodes.clear();
        }
        self.nodes.retain(|&key| {
            let place = cut.find(key);
            cut.node(place).key != key || cut.lacks(place)
        });
    }

    /// The leaves above what is expected, as if a ray had met each: so they are split a level a frame, where feedback takes
    /// some frames for each. What was not split before, for nobody saw it, is left to rays.
    pub(super) fn met(&self, cut: &Cut) -> Vec<Feedback> {
        let above = |&key: &NodeKey| Some(cut.node(cut.find(key)).key).filter(|&leaf| leaf != key);
        let mut leaves: Vec<NodeKey> = self.nodes.iter().filter_map(above).collect();
        leaves.sort_unstable();
        leaves.dedup();
        leaves.into_iter().map(|leaf| Feedback::met(leaf, 1)).collect()
    }

    /// What is expected, from the root down.
    pub(super) fn nodes(&self) -> impl Iterator<Item = NodeKey> + '_ {
        self.nodes.iter().copied()
    }
}
