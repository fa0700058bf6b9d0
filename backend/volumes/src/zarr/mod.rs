//! OME-Zarr images (0.4 on Zarr v2, 0.5 on Zarr v3) and bare Zarr arrays, in folders.

mod array;
mod axes;
mod bounded;
mod files;
mod find;
mod image;
mod layer;
mod node;
#[cfg(test)]
mod tests;
mod volume;

use super::Selection;
use bricks::volume::{VolumeError, VolumeReader};
use std::path::Path;

/// Whether a path is a folder that says it is Zarr.
pub(super) fn is_zarr(path: &Path) -> bool {
    path.is_dir() && node::METADATA_FILES.iter().any(|name| path.join(name).is_file())
}

/// Opens an image or an array. Lengths whose unit is not given are millimetres; an axis that is not there has one
/// voxel; half floats are handed out as f32, and truth values as 0 and 1.
///
/// # Errors
/// Metadata that contradict themselves or promise what cannot be, a codec or a number type that is not known, and a
/// choice that is not made or does not exist: one sentence each.
pub(super) fn open(path: &Path, selection: &Selection) -> Result<Box<dyn VolumeReader>, VolumeError> {
    let image = find::image(path, selection)?;
    Ok(Box::new(volume::ZarrVolume::open(path, &image, selection)?))
}
