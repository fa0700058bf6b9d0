//! The octree of bricks: its geometry, what a brick is, where bricks come from, and the file that keeps them.

mod brick;
mod build;
#[cfg(test)]
mod build_tests;
mod bytes;
mod cells;
mod codec;
mod codes;
#[cfg(test)]
mod damage_tests;
mod eight_bits;
mod entry;
mod error;
mod file;
mod format;
mod format_v1;
mod halve;
#[cfg(test)]
mod hard_tests;
#[cfg(test)]
mod hostile_tests;
mod intake;
mod level;
mod node_table;
mod octree;
mod options;
mod pack;
mod quantise;
mod read_at;
#[cfg(test)]
mod resign;
mod ring;
mod sink;
mod source;
mod stream;
mod table;
mod tally;
mod tree;
mod verify;
mod writer;

pub use brick::{Brick, Deviation};
pub use build::build;
pub use cells::CellRanges;
pub use codec::Codec;
pub use codes::{BRICK_EDGE, BRICK_VOXELS, CodeBits, Codes, OVERLAP, OWN_EDGE};
pub use eight_bits::EightBits;
pub use error::StoreError;
pub use file::Store;
pub use octree::{NodeKey, OctreeShape};
pub use options::{BuildOptions, BuildReport, Emptiness, LevelError};
pub use quantise::quantise;
pub use source::{BrickError, BrickErrorKind, BrickSource, NodeSummary, is_shown};
pub use verify::{MOST_DAMAGES, Verification, verify};
