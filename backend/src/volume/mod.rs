//! Volumes as users have them: file readers and procedural fields.

mod choice;
mod data_files;
mod data_stream;
mod dicom;
mod element;
mod error;
mod file;
mod frame;
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
mod samples;
mod shape;
mod text_numbers;
mod tiff;
mod zarr;

pub use element::{ByteOrder, Element};
pub use error::VolumeError;
pub use frame::{Space, VolumeFrame};
pub use open::open;
pub use raw::RawLayout;
pub use reader::{MAX_EDGE_VOXELS, Selection, VolumeInfo, VolumeReader};
pub(crate) use samples::with_samples;
pub use samples::{Sample, Samples};
