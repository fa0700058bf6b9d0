//! The octree of bricks: its geometry, what a brick is, and where bricks come from.

mod brick;
mod octree;
mod source;

pub use brick::{BRICK_EDGE, BRICK_VOXELS, Brick, Codes, OVERLAP, OWN_EDGE};
pub use octree::{NodeKey, OctreeShape};
pub use source::{BrickError, BrickSource, NodeSummary};
