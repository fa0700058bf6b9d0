//! NIfTI-1 and NIfTI-2 files: header and voxels in one (.nii, .nii.gz) or in two (.hdr, .img).

mod frame;
mod header;
mod place;
mod unpacked;

use super::Selection;
use super::choice::{Several, choose};
use super::data_stream::Start;
use super::file::FileLayout;
use super::shape::{Axis, Shape};
use bricks::volume::{Element, Modality, VolumeError};
use header::Header;
pub(super) use header::is_header;
use std::path::Path;

/// Reads the header. The fourth axis is time, the fifth the channels, as the standard has them.
pub(super) fn layout(path: &Path, selection: &Selection) -> Result<FileLayout, VolumeError> {
    let header = Header::read(&place::header_path(path)?)?;
    let element = element(path, header.datatype)?;
    let shape =
        Shape::new(&axes(path, &header, selection)?).map_err(|what| VolumeError::header(path, what))?;
    let (file, packing) = place::voxels(&header)?;
    let (slope, intercept) = scaling(path, &header);
    Ok(FileLayout {
        header_path: path.into(),
        files: file,
        start: Start { unpacked_bytes: voxels_offset(path, &header)?, ..Start::default() },
        shape,
        frame: frame::frame(&header)?,
        modality: Modality::Unknown,
        element,
        byte_order: header.byte_order,
        packing,
        slope,
        intercept,
    })
}

fn axes(path: &Path, header: &Header, selection: &Selection) -> Result<Vec<(i64, Axis)>, VolumeError> {
    let count = header.dim[0];
    if !(1..=7).contains(&count) {
        return Err(VolumeError::header(path, format!("it claims {count} axes, and 1 to 7 are possible")));
    }
    let size = |axis: usize| if axis as i64 <= count { header.dim[axis] } else { 1 };
    if let Some(axis) = (6..=7).find(|&axis| size(axis) > 1) {
        let what = format!("it has {} places along axis {axis}: save one of them", size(axis));
        return Err(VolumeError::unsupported(path, what));
    }
    // Some programs write 0 for an axis that is not used.
    let (times, channels) = (size(4).max(1), size(5).max(1));
    let time = choose(path, Several::Times, times, selection.time)?;
    let channel = choose(path, Several::Channels, channels, selection.channel)?;
    let space = [1, 2, 3].map(|axis| (size(axis), Axis::Volume));
    Ok(space.into_iter().chain([(times, Axis::At(time)), (channels, Axis::At(channel))]).collect())
}

/// Codes of nifti1.h.
fn element(path: &Path, datatype: i16) -> Result<Element, VolumeError> {
    let kind = match datatype {
        2 => return Ok(Element::U8),
        4 => return Ok(Element::I16),
        8 => return Ok(Element::I32),
        16 => return Ok(Element::F32),
        64 => return Ok(Element::F64),
        256 => return Ok(Element::I8),
        512 => return Ok(Element::U16),
        768 => return Ok(Element::U32),
        1024 => return Ok(Element::I64),
        1280 => return Ok(Element::U64),
        1 => "single bits",
        32 | 1792 | 2048 => "complex numbers",
        128 | 2304 => "colours",
        1536 => "floats of 16 bytes",
        _ => "unknown",
    };
    let what =
        format!("its data type {datatype} ({kind}) is not supported: save it as 16-bit integers or floats");
    Err(VolumeError::unsupported(path, what))
}

/// Bytes before the voxels in their file; a file with a header has at least that.
fn voxels_offset(path: &Path, header: &Header) -> Result<u64, VolumeError> {
    let offset = header.vox_offset;
    if !(0.0..=1e9).contains(&offset) {
        return Err(VolumeError::header(path, format!("its voxels are said to start at byte {offset}")));
    }
    Ok((offset as u64).max(header.earliest_voxels()))
}

/// Slope and intercept. The standard says that a slope of zero means no scaling; programs also write NaN for both.
fn scaling(path: &Path, header: &Header) -> (f64, f64) {
    let (slope, intercept) = (header.slope, header.intercept);
    let is_unset = slope == 0.0 || (slope.is_nan() && !intercept.is_infinite());
    let is_usual = slope.is_finite() && intercept.is_finite();
    if !is_unset && !is_usual {
        let path = path.display();
        tracing::warn!(%path, slope, intercept, "its scaling is not of numbers, and what is not is passed over");
    }
    match is_unset || !slope.is_finite() {
        true => (1.0, 0.0),
        false => (slope, if intercept.is_finite() { intercept } else { 0.0 }),
    }
}
