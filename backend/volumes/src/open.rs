//! Opening a volume file: which format is it?

use super::file::FileVolume;
use super::{Selection, dicom, metaimage, nifti, nrrd, raw, tiff, zarr};
use bricks::volume::{VolumeError, VolumeReader};
use flate2::read::MultiGzDecoder;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes read to recognise a format.
const MAGIC_BYTES: u64 = 512;

/// A format that describes itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Nrrd,
    Nifti,
    MetaImage,
    Dicom,
    Tiff,
    Zarr,
}

/// Opens a volume. With a raw layout the file is read as raw voxels of it, whatever its name; without, the
/// extension decides the format, or the first bytes if the extension is unknown. A folder holds a DICOM
/// series, TIFF slices or an OME-Zarr image.
///
/// # Errors
/// A missing file, a wrong header, fewer bytes than promised, an unknown format or element type: one sentence.
pub fn open(path: &Path, selection: &Selection) -> Result<Box<dyn VolumeReader>, VolumeError> {
    let mut layout = match &selection.raw {
        Some(raw) => raw::layout(path, raw)?,
        None => match format(path)? {
            Format::Nrrd => nrrd::layout(path, selection)?,
            Format::Nifti => nifti::layout(path, selection)?,
            Format::MetaImage => metaimage::layout(path, selection)?,
            Format::Dicom => return dicom::open(path, selection),
            Format::Tiff => return tiff::open(path, selection),
            Format::Zarr => return zarr::open(path, selection),
        },
    };
    if let Some(spacing_mm) = selection.spacing_mm {
        layout.frame = layout.frame.with_voxel_size(spacing_mm * 1e-3);
    }
    Ok(Box::new(FileVolume::new(layout)?))
}

fn format(path: &Path) -> Result<Format, VolumeError> {
    if path.is_dir() {
        return format_of_folder(path);
    }
    let start = first_bytes(path)?;
    let format = by_extension(path).or_else(|| by_magic(&start));
    format.ok_or_else(|| VolumeError::UnknownFormat { path: path.into() })
}

fn format_of_folder(folder: &Path) -> Result<Format, VolumeError> {
    if zarr::is_zarr(folder) {
        Ok(Format::Zarr)
    } else if dicom::is_in(folder)? {
        Ok(Format::Dicom)
    } else if !tiff::slices_in(folder)?.is_empty() {
        Ok(Format::Tiff)
    } else {
        let what = "the folder holds no DICOM images, TIFF slices or Zarr array: give the file or folder with the volume";
        Err(VolumeError::unsupported(folder, what))
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
    } else if tiff::has_extension(path) {
        Some(Format::Tiff)
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
    } else if dicom::is_dicom(start) {
        Some(Format::Dicom)
    } else if tiff::is_tiff(start) {
        Some(Format::Tiff)
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
