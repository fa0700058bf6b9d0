//! A volume whose bricks are made once: many renderers, as of many back-ends, then share them.

use bricks::volume::VolumeFrame;
use bricks::{Brick, BrickError, BrickSource, CellRanges, NodeKey, NodeSummary, OctreeShape};
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, PoisonError, RwLock};

/// A source, and all that was asked of it so far.
pub struct Remembered {
    source: Arc<dyn BrickSource>,
    bricks: Memory<Brick>,
    summaries: Memory<NodeSummary>,
}

type Memory<V> = RwLock<HashMap<NodeKey, V>>;

impl Remembered {
    /// A memory of `source`, empty.
    pub fn new(source: Arc<dyn BrickSource>) -> Self {
        Self { source, bricks: RwLock::default(), summaries: RwLock::default() }
    }
}

fn known<K: Eq + Hash, V: Clone>(memory: &RwLock<HashMap<K, V>>, key: &K) -> Option<V> {
    memory.read().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
}

fn keep<K: Eq + Hash, V>(memory: &RwLock<HashMap<K, V>>, key: K, value: V) {
    memory.write().unwrap_or_else(PoisonError::into_inner).insert(key, value);
}

impl BrickSource for Remembered {
    fn shape(&self) -> OctreeShape {
        self.source.shape()
    }

    fn frame(&self) -> VolumeFrame {
        self.source.frame()
    }

    fn has_deviation(&self) -> bool {
        self.source.has_deviation()
    }

    fn value_range(&self) -> (f64, f64) {
        self.source.value_range()
    }

    fn summary(&self, node: NodeKey) -> NodeSummary {
        known(&self.summaries, &node).unwrap_or_else(|| {
            let summary = self.source.summary(node);
            keep(&self.summaries, node, summary);
            summary
        })
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        if let Some(brick) = known(&self.bricks, &node) {
            return Ok(brick);
        }
        let mut brick = self.source.brick(node)?;
        brick.cells = brick.cells.or_else(|| Some(CellRanges::of(&brick.codes)));
        keep(&self.bricks, node, brick.clone());
        Ok(brick)
    }
}
