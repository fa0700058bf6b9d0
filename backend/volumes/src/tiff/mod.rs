//! TIFF stacks: a file of many pages, or a folder of slices (TIFF 6.0, BigTIFF, ImageJ, OME-TIFF).

mod ends;
mod gaps;
mod hyperstack;
mod imagej;
mod natural;
mod ome;
mod pages;
mod relabel;
#[cfg(test)]
mod tests;
mod volume;
mod xml_depth;

use super::Selection;
use bricks::volume::{VolumeError, VolumeReader};
use std::path::{Path, PathBuf};

/// What files of either byte order start with, TIFF and BigTIFF.
const MAGICS: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

/// Whether a file that starts with these bytes is a TIFF file.
pub(super) fn is_tiff(start: &[u8]) -> bool {
    MAGICS.iter().any(|magic| start.starts_with(magic))
}

/// Whether a path ends as that of a TIFF file does.
pub(super) fn has_extension(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    matches!(extension.as_deref(), Some("tif" | "tiff"))
}

/// Opens a file, or the files of a folder.
pub(super) fn open(path: &Path, selection: &Selection) -> Result<Box<dyn VolumeReader>, VolumeError> {
    if path.is_dir() {
        return Ok(Box::new(volume::TiffVolume::of_files(path, slices_in(path)?, selection)?));
    }
    Ok(Box::new(volume::TiffVolume::of_file(path, selection)?))
}

/// The TIFF files of a folder, `z2` before `z10`.
pub(super) fn slices_in(folder: &Path) -> Result<Vec<PathBuf>, VolumeError> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(VolumeError::open(folder))? {
        let path = entry.map_err(VolumeError::open(folder))?.path();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if has_extension(&path) && !is_hidden && path.is_file() {
            paths.push(path);
        }
    }
    paths.sort_by_cached_key(|path| natural::key(&path.to_string_lossy()));
    Ok(paths)
}
