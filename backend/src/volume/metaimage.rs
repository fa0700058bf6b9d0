//! MetaImage headers (.mhd with a file of voxels beside it, .mha with the voxels inside).

use super::file::{FileLayout, Packing, file_length};
use super::header_text::{HeaderText, Line};
use super::{ByteOrder, Element, VolumeError, VolumeFrame};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Reads the header. MetaImage gives no unit of length; millimetres are usual and assumed.
pub(super) fn layout(path: &Path) -> Result<FileLayout, VolumeError> {
    let header = HeaderText::read(path, line)?;
    check_kind(path, &header)?;
    let dims = header.dims("DimSize", header.need("dimsize")?)?;
    let element = element(path, header.need("elementtype")?)?;
    let packing = if flag(&header, "compresseddata") { Packing::Zlib } else { Packing::Plain };
    let voxels: u64 = dims.to_array().map(u64::from).iter().fold(1, |n, &edge| n.saturating_mul(edge));
    let bytes = voxels.saturating_mul(element.bytes() as u64);
    let (data_path, file_offset) = place(path, &header, bytes)?;
    Ok(FileLayout {
        header_path: path.into(),
        data_path,
        dims,
        frame: VolumeFrame::of_voxels(spacing_mm(&header)? * 1e-3),
        element,
        byte_order: byte_order(&header),
        packing,
        file_offset,
        data_offset: 0,
        slope: 1.0,
        intercept: 0.0,
    })
}

/// The header ends with the line that names the data file.
fn line(_number: usize, text: &str) -> Line {
    match text.split_once('=') {
        Some((key, value)) if key.trim() == "ElementDataFile" => Line::Last(key.trim().into(), value.into()),
        Some((key, value)) => Line::Field(key.trim().into(), value.into()),
        None if text.trim().is_empty() => Line::Ignored,
        None => Line::Wrong,
    }
}

fn check_kind(path: &Path, header: &HeaderText) -> Result<(), VolumeError> {
    let unsupported = |what: &str| Err(VolumeError::unsupported(path, what));
    if header.need("ndims")? != "3" {
        return unsupported("it does not have three dimensions (NDims): save one volume of it");
    }
    if header.get(&["elementnumberofchannels"]).is_some_and(|channels| channels != "1") {
        return unsupported("it has several channels per voxel: save one of them");
    }
    if header.get(&["binarydata"]).is_some() && !flag(header, "binarydata") {
        return unsupported("its voxels are written as text (BinaryData): save it as binary");
    }
    Ok(())
}

fn flag(header: &HeaderText, key: &str) -> bool {
    header.get(&[key]).is_some_and(|value| value.starts_with(['T', 't', '1', 'Y', 'y']))
}

fn byte_order(header: &HeaderText) -> ByteOrder {
    match flag(header, "binarydatabyteordermsb") || flag(header, "elementbyteordermsb") {
        true => ByteOrder::Big,
        false => ByteOrder::Little,
    }
}

fn spacing_mm(header: &HeaderText) -> Result<DVec3, VolumeError> {
    match header.get(&["elementspacing"]).or_else(|| header.get(&["elementsize"])) {
        Some(value) => Ok(header.lengths("ElementSpacing", value)?.abs()),
        None => Ok(DVec3::ONE),
    }
}

fn element(path: &Path, name: &str) -> Result<Element, VolumeError> {
    Ok(match name {
        "MET_UCHAR" => Element::U8,
        "MET_CHAR" => Element::I8,
        "MET_USHORT" => Element::U16,
        "MET_SHORT" => Element::I16,
        "MET_UINT" => Element::U32,
        "MET_INT" => Element::I32,
        "MET_FLOAT" => Element::F32,
        "MET_DOUBLE" => Element::F64,
        _ => {
            let what = format!("its element type {name} is not supported: save it as MET_SHORT or MET_FLOAT");
            return Err(VolumeError::unsupported(path, what));
        }
    })
}

/// The file with the voxels, and the bytes before them.
fn place(path: &Path, header: &HeaderText, bytes: u64) -> Result<(PathBuf, u64), VolumeError> {
    let name = header.need("elementdatafile")?;
    if name == "LOCAL" {
        return Ok((path.into(), header.length));
    }
    if name.is_empty() {
        return Err(header.wrong("`ElementDataFile` is empty, and must be LOCAL or the name of a file"));
    }
    if name.starts_with("LIST") || name.contains('%') {
        return Err(VolumeError::unsupported(path, "its slices are separate files: save it as one file"));
    }
    let data_path = header.beside(name);
    let offset = match header.get(&["headersize"]) {
        None => 0,
        Some("-1") => file_length(&data_path)?.saturating_sub(bytes),
        Some(value) => header.number("HeaderSize", value)?,
    };
    Ok((data_path, offset))
}
