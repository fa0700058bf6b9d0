//! Opening a volume file: which format is it?

use super::choice::{Several, no_series, only_one};
use super::file::FileVolume;
use super::{RawLayout, Selection, dicom, metaimage, nifti, nrrd, raw, tiff, zarr};
use bricks::volume::{VolumeError, VolumeReader, open_file};
use flate2::read::MultiGzDecoder;
use std::io::Read;
use std::path::Path;

/// Bytes read to recognise a format.
const MAGIC_BYTES: u64 = 512;

/// A format: one that describes itself, or raw voxels as the user describes them.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Format<'a> {
    Raw(&'a RawLayout),
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
    let format = match &selection.raw {
        Some(raw) => Format::Raw(raw),
        None => format(path)?,
    };
    check_choices(path, format, selection)?;
    let mut layout = match format {
        Format::Raw(raw) => raw::layout(path, raw)?,
        Format::Nrrd => nrrd::layout(path, selection)?,
        Format::Nifti => nifti::layout(path, selection)?,
        Format::MetaImage => metaimage::layout(path, selection)?,
        Format::Dicom => return dicom::open(path, selection),
        Format::Tiff => return tiff::open(path, selection),
        Format::Zarr => return zarr::open(path, selection),
    };
    if let Some(spacing_mm) = selection.spacing_mm {
        layout.frame = layout.frame.with_voxel_size(spacing_mm * 1e-3);
    }
    Ok(Box::new(FileVolume::new(layout)?))
}

/// Refuses choices that the format cannot offer: what is not there must not be passed over. The others are the readers'
/// to judge.
fn check_choices(path: &Path, format: Format, selection: &Selection) -> Result<(), VolumeError> {
    let &Selection { level, channel, time, .. } = selection;
    if format != Format::Zarr {
        only_one(path, Several::Levels, level)?;
    }
    if matches!(format, Format::Raw(_) | Format::Dicom) {
        only_one(path, Several::Channels, channel)?;
    }
    if matches!(format, Format::Raw(_)) {
        only_one(path, Several::Times, time)?;
    }
    match format {
        Format::Dicom | Format::Zarr => Ok(()),
        _ => no_series(path, selection.series.as_deref()),
    }
}

fn format(path: &Path) -> Result<Format<'static>, VolumeError> {
    if path.is_dir() {
        return format_of_folder(path);
    }
    let start = first_bytes(path)?;
    let format = by_extension(path).or_else(|| by_magic(&start));
    format.ok_or_else(|| VolumeError::UnknownFormat { path: path.into() })
}

fn format_of_folder(folder: &Path) -> Result<Format<'static>, VolumeError> {
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

fn by_extension(path: &Path) -> Option<Format<'static>> {
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

fn by_magic(start: &[u8]) -> Option<Format<'static>> {
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
        let file = open_file(path)?;
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
