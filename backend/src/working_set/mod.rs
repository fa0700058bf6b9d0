//! Which bricks are resident: the cut through the octree, its index, its loader.

mod lod;

pub use lod::LodRule;
