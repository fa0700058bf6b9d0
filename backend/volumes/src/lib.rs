//! Volumes as users have them: readers of volume files, import into a store, export.

mod choice;
mod data_files;
mod data_stream;
mod dicom;
pub mod export;
mod file;
mod gzip;
mod header_text;
mod import;
mod metaimage;
mod nifti;
mod nrrd;
mod open;
mod packing;
mod raw;
#[cfg(test)]
mod reader_tests;
mod selection;
mod shape;
mod text_numbers;
mod tiff;
mod zarr;

pub use import::{ImportOptions, PROCEDURAL_PREFIX, import};
pub use open::open;
pub use raw::RawLayout;
pub use selection::Selection;
