//! MetaImage headers (.mhd with files of voxels beside it, .mha with the voxels inside).

mod frame;
mod place;

use super::Selection;
use super::choice::{Several, choose};
use super::file::FileLayout;
use super::header_text::{HeaderText, Line};
use super::packing::Packing;
use super::shape::{Axis, Shape};
use bricks::volume::{ByteOrder, Element, Modality, VolumeError};
use std::path::Path;

/// Reads the header.
pub(super) fn layout(path: &Path, selection: &Selection) -> Result<FileLayout, VolumeError> {
    let header = HeaderText::read(path, line)?;
    let sizes = sizes(path, &header)?;
    let element = element(path, header.need("elementtype")?)?;
    let packing = packing(path, &header)?;
    let shape = Shape::new(&axes(path, &header, selection, &sizes)?).map_err(|what| header.wrong(what))?;
    Ok(FileLayout {
        header_path: path.into(),
        files: place::files(path, &header, &sizes)?,
        start: place::start(&header, packing)?,
        shape,
        frame: frame::frame(&header, sizes.len())?,
        modality: modality(&header),
        element,
        byte_order: byte_order(&header),
        packing,
        slope: 1.0,
        intercept: 0.0,
    })
}

/// The header ends with the line that names the data file.
fn line(_number: usize, text: &str) -> Line {
    match text.split_once('=') {
        Some((key, value)) if key.trim() != place::DATA_FILE => Line::Field(key.trim().into(), value.into()),
        Some((key, value)) if place::is_list(value) => Line::List(key.trim().into(), value.into()),
        Some((key, value)) => Line::Last(key.trim().into(), value.into()),
        None if text.trim().is_empty() => Line::Ignored,
        None => Line::Wrong,
    }
}

/// Voxels along x, y, z, and points in time where there is a fourth axis.
fn sizes(path: &Path, header: &HeaderText) -> Result<Vec<i64>, VolumeError> {
    let axes: usize = header.number("NDims", header.need("ndims")?)?;
    if !(3..=4).contains(&axes) {
        let what =
            format!("it has {axes} axes (NDims), and a volume has three or, with time, four: save one");
        return Err(VolumeError::unsupported(path, what));
    }
    header.exactly("DimSize", header.need("dimsize")?, axes)
}

/// The axes of the array: the channels are its fastest.
fn axes(
    path: &Path,
    header: &HeaderText,
    selection: &Selection,
    sizes: &[i64],
) -> Result<Vec<(i64, Axis)>, VolumeError> {
    let channels = match header.get(&["elementnumberofchannels"]) {
        Some(value) => header.number("ElementNumberOfChannels", value)?,
        None => 1,
    };
    let times = sizes.get(3).copied().unwrap_or(1);
    let channel = choose(path, Several::Channels, channels, selection.channel)?;
    let time = choose(path, Several::Times, times, selection.time)?;
    let role = |axis: usize| if axis < 3 { Axis::Volume } else { Axis::At(time) };
    let rest = sizes.iter().enumerate().map(|(axis, &size)| (size, role(axis)));
    Ok(std::iter::once((channels, Axis::At(channel))).chain(rest).collect())
}

fn flag(header: &HeaderText, key: &str) -> bool {
    header.get(&[key]).is_some_and(|value| value.starts_with(['T', 't', '1', 'Y', 'y']))
}

fn packing(path: &Path, header: &HeaderText) -> Result<Packing, VolumeError> {
    let is_text = header.get(&["binarydata"]).is_some() && !flag(header, "binarydata");
    match (flag(header, "compresseddata"), is_text) {
        (false, false) => Ok(Packing::Plain),
        (true, false) => Ok(Packing::Zlib),
        (false, true) => Ok(Packing::Text),
        (true, true) => {
            let what = "its voxels are packed and written as text (BinaryData): save it as binary";
            Err(VolumeError::unsupported(path, what))
        }
    }
}

fn modality(header: &HeaderText) -> Modality {
    match header.get(&["modality"]) {
        Some("MET_MOD_CT") => Modality::Ct,
        Some("MET_MOD_MR") => Modality::Mr,
        _ => Modality::Unknown,
    }
}

fn byte_order(header: &HeaderText) -> ByteOrder {
    match flag(header, "binarydatabyteordermsb") || flag(header, "elementbyteordermsb") {
        true => ByteOrder::Big,
        false => ByteOrder::Little,
    }
}

/// The types' sizes are those of MetaIO's table, in which a long has 4 bytes on every machine.
fn element(path: &Path, name: &str) -> Result<Element, VolumeError> {
    Ok(match name {
        "MET_UCHAR" => Element::U8,
        "MET_CHAR" => Element::I8,
        "MET_USHORT" => Element::U16,
        "MET_SHORT" => Element::I16,
        "MET_UINT" | "MET_ULONG" => Element::U32,
        "MET_INT" | "MET_LONG" => Element::I32,
        "MET_ULONG_LONG" => Element::U64,
        "MET_LONG_LONG" => Element::I64,
        "MET_FLOAT" => Element::F32,
        "MET_DOUBLE" => Element::F64,
        _ => {
            let what = format!("its element type {name} is not supported: save it as MET_SHORT or MET_FLOAT");
            return Err(VolumeError::unsupported(path, what));
        }
    })
}
