//! What rays asked for in one frame.

use bricks::NodeKey;
use std::collections::BTreeMap;

/// A node that rays sampled, at the level they sampled it at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Demanded {
    /// Which node.
    pub key: NodeKey,
    /// Rays that sampled it, at least 1.
    pub rays: u32,
}

/// The nodes that rays sampled in one frame, each once, in the order of their keys.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    nodes: Vec<Demanded>,
}

impl Demand {
    /// Gathers nodes and their rays: those of a node that comes several times, from several views, add up, and nodes
    /// without rays are left out.
    pub fn new(sampled: impl IntoIterator<Item = (NodeKey, u32)>) -> Self {
        let mut nodes = BTreeMap::<NodeKey, u32>::new();
        for (key, rays) in sampled {
            let sum = nodes.entry(key).or_default();
            *sum = sum.saturating_add(rays);
        }
        let kept = nodes.into_iter().filter(|&(_, rays)| rays > 0);
        Self { nodes: kept.map(|(key, rays)| Demanded { key, rays }).collect() }
    }

    /// The nodes, in the order of their keys.
    pub fn nodes(&self) -> &[Demanded] {
        &self.nodes
    }

    /// All rays of all nodes: a ray counts once for every node that it sampled.
    pub fn rays(&self) -> u64 {
        self.nodes.iter().map(|node| u64::from(node.rays)).sum()
    }
}
