//! Volumes as users have them: file readers and procedural fields.

mod element;
mod error;
mod file;
mod header_text;
mod metaimage;
mod nifti;
mod nrrd;
mod open;
pub mod procedural;
mod raw;
mod reader;
#[cfg(test)]
mod reader_tests;

pub use element::{ByteOrder, Element};
pub use error::VolumeError;
pub use open::open;
pub use raw::RawLayout;
pub use reader::{MAX_EDGE_VOXELS, VolumeInfo, VolumeReader};
