//! DICOM series: a folder of slices, one of them, or a file with many frames (PS3.3, PS3.5, PS3.10).

mod attributes;
mod decode;
mod header;
#[cfg(test)]
mod hostile_tests;
mod jpeg;
mod lengths;
mod pixels;
mod rle;
mod scan;
mod stack;
mod start;
mod syntax;
#[cfg(test)]
mod tests;
mod volume;

use super::Selection;
use bricks::volume::{VolumeError, VolumeReader};
pub(super) use scan::is_in;
use std::path::Path;

/// Whether a file that starts with these bytes is a DICOM file.
pub(super) fn is_dicom(start: &[u8]) -> bool {
    start::Start::of(start).is_some()
}

/// Opens the series in a folder, or around a file.
pub(super) fn open(path: &Path, selection: &Selection) -> Result<Box<dyn VolumeReader>, VolumeError> {
    let all = if path.is_dir() { scan::series_in(path)? } else { scan::series_of(path)? };
    if all.is_empty() {
        return Err(VolumeError::unsupported(path, "it holds no DICOM image"));
    }
    let series = scan::choose(path, all, selection.series.as_deref())?;
    let stack = stack::stack(path, series, selection)?;
    Ok(Box::new(volume::DicomVolume::new(path, stack, selection)?))
}
