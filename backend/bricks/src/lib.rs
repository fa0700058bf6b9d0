//! The octree of bricks: its geometry, what a brick is, where bricks come from, how fine they must be, and the store that
//! keeps them.

pub mod links;
mod lod;
pub mod procedural;
pub mod store;
pub mod temporary;
pub mod volume;
pub mod working_file;
pub mod working_folder;

pub use lod::{LodRule, MeasuredRule};
pub use store::{
    BRICK_EDGE, BRICK_VOXELS, Brick, BrickError, BrickErrorKind, BrickSource, CellRanges, Codes, Deviation,
    NodeKey, NodeSummary, OVERLAP, OWN_EDGE, OctreeShape, is_shown,
};
