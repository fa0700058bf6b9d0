//! What the rays of a frame found of a leaf.

use bricks::NodeKey;

/// What the rays of a frame, of whatever views, found of a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feedback {
    /// Which node.
    pub key: NodeKey,
    /// Rays that sampled it, at least 1.
    pub rays: u32,
    /// Levels it was too coarse by; at most 0 where it was fine enough or no finer level exists.
    pub deficit: f64,
}

impl Feedback {
    /// Of a leaf that was fine enough.
    pub fn met(key: NodeKey, rays: u32) -> Self {
        Self { key, rays, deficit: 0.0 }
    }
}
