//! The octree of bricks: its geometry, what a brick is, where bricks come from, and the file that keeps them.

mod brick;
mod build;
#[cfg(test)]
mod build_tests;
mod codec;
#[cfg(test)]
mod damage_tests;
mod error;
mod file;
mod format;
mod import;
mod node_table;
mod octree;
mod quantise;
mod sink;
mod slabs;
mod source;
mod survey;
mod verify;

pub use brick::{BRICK_EDGE, BRICK_VOXELS, Brick, Codes, OVERLAP, OWN_EDGE};
pub use build::{BuildOptions, BuildReport, Emptiness, LevelError, build};
pub use codec::Codec;
pub use error::StoreError;
pub use file::Store;
pub use import::{ImportOptions, PROCEDURAL_PREFIX, import};
pub use octree::{NodeKey, OctreeShape};
pub use quantise::{CodeBits, quantise};
pub use source::{BrickError, BrickSource, NodeSummary};
pub use verify::{MOST_DAMAGES, Verification, verify};
