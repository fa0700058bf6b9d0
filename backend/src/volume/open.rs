//! Opening a volume file: which format is it?

use super::file::{FileLayout, FileVolume};
use super::{Selection, VolumeError, VolumeReader, metaimage, nifti, nrrd, raw, zarr};
use flate2::read::MultiGzDecoder;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes looked at to tell a format.
const MAGIC_BYTES: u64 = 512;

/// A format with a header of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Nrrd,
    Nifti,
    MetaImage,
}

/// Opens a volume: a file, or a Zarr folder. With a raw layout the file is read as raw voxels of it, whatever its name; without, the
/// extension tells the format, and the first bytes do where the extension is not known.
///
/// # Errors
/// A missing file, a wrong header, fewer bytes than promised, an unknown format or element type: one sentence.
pub fn open(path: &Path, selection: &Selection) -> Result<Box<dyn VolumeReader>, VolumeError> {
    if selection.raw.is_none() && zarr::is_zarr(path) {
        return zarr::open(path, selection);
    }
    let mut layout = match &selection.raw {
        Some(raw) => raw::layout(path, raw)?,
        None => layout(path, selection)?,
    };
    if let Some(spacing_mm) = selection.spacing_mm {
        layout.frame = layout.frame.with_voxel_size(spacing_mm * 1e-3);
    }
    Ok(Box::new(FileVolume::new(layout)?))
}

fn layout(path: &Path, selection: &Selection) -> Result<FileLayout, VolumeError> {
    let start = first_bytes(path)?;
    let format = by_extension(path).or_else(|| by_magic(&start));
    match format.ok_or_else(|| VolumeError::UnknownFormat { path: path.into() })? {
        Format::Nrrd => nrrd::layout(path, selection),
        Format::Nifti => nifti::layout(path, selection),
        Format::MetaImage => metaimage::layout(path, selection),
    }
}

fn by_extension(path: &Path) -> Option<Format> {
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    if ends(&[".nrrd", ".nhdr"]) {
        Some(Format::Nrrd)
    } else if ends(&[".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"]) {
        Some(Format::Nifti)
    } else if ends(&[".mhd", ".mha"]) {
        Some(Format::MetaImage)
    } else {
        None
    }
}

fn by_magic(start: &[u8]) -> Option<Format> {
    if start.starts_with(b"NRRD") {
        Some(Format::Nrrd)
    } else if nifti::is_header(start) {
        Some(Format::Nifti)
    } else if start.starts_with(b"ObjectType") || start.starts_with(b"NDims") {
        Some(Format::MetaImage)
    } else {
        None
    }
}

/// The first bytes, unpacked where the file is a gzip file.
fn first_bytes(path: &Path) -> Result<Vec<u8>, VolumeError> {
    super::file::file_length(path)?;
    let read = |packed: bool| -> std::io::Result<Vec<u8>> {
        let mut start = Vec::new();
        let file = File::open(path)?;
        match packed {
            false => file.take(MAGIC_BYTES).read_to_end(&mut start)?,
            true => MultiGzDecoder::new(file).take(MAGIC_BYTES).read_to_end(&mut start)?,
        };
        Ok(start)
    };
    let start = read(false).map_err(VolumeError::open(path))?;
    match start.starts_with(&[0x1f, 0x8b]) {
        true => read(true).map_err(VolumeError::read(path)),
        false => Ok(start),
    }
}
