//! NRRD headers (.nrrd with the voxels inside, .nhdr with one file of voxels beside it or several).

mod axes;
mod data_file;
mod frame;
mod place;

use super::Selection;
use super::file::FileLayout;
use super::header_text::{HeaderText, Line};
use super::packing::Packing;
use super::shape::Shape;
use axes::Axes;
use bricks::volume::{ByteOrder, Element, Modality, VolumeError};
use data_file::{DATA_FILE, is_list};
use std::path::Path;

/// Reads the header. Lengths are millimetres unless `space units` or `units` say otherwise.
pub(super) fn layout(path: &Path, selection: &Selection) -> Result<FileLayout, VolumeError> {
    let header = HeaderText::read(path, line)?;
    let element = element(path, &header)?;
    let axes = Axes::read(path, &header)?;
    let shape = Shape::new(&axes.choose(path, selection)?).map_err(|what| header.wrong(what))?;
    let packing = packing(path, &header)?;
    Ok(FileLayout {
        header_path: path.into(),
        files: place::files(path, &header, &axes.sizes)?,
        start: place::start(&header, packing)?,
        shape,
        frame: frame::frame(&header, &axes)?,
        modality: Modality::Unknown,
        element,
        byte_order: byte_order(&header, element, packing)?,
        packing,
        slope: 1.0,
        intercept: 0.0,
    })
}

/// The header ends with an empty line; a detached one may end with its file.
fn line(number: usize, text: &str) -> Line {
    if number == 0 {
        return if text.starts_with("NRRD000") { Line::Ignored } else { Line::Wrong };
    }
    if text.is_empty() {
        return Line::End;
    }
    if text.starts_with('#') {
        return Line::Ignored;
    }
    match text.split_once(": ") {
        // A pair of key and value has no meaning that the format knows of.
        Some((key, _)) if key.contains(":=") => Line::Ignored,
        Some((key, value)) if has_list(key, value) => Line::List(key.trim().into(), value.into()),
        Some((key, value)) => Line::Field(key.trim().into(), value.into()),
        None if text.contains(":=") => Line::Ignored,
        None => Line::Wrong,
    }
}

fn has_list(key: &str, value: &str) -> bool {
    DATA_FILE.contains(&key.trim().to_ascii_lowercase().as_str()) && is_list(value)
}

fn element(path: &Path, header: &HeaderText) -> Result<Element, VolumeError> {
    let name = header.need("type")?;
    Element::from_name(name).ok_or_else(|| {
        let what = format!("its type {name:?} is not supported: save it as short or float");
        VolumeError::unsupported(path, what)
    })
}

fn packing(path: &Path, header: &HeaderText) -> Result<Packing, VolumeError> {
    match header.need("encoding")?.to_ascii_lowercase().as_str() {
        "raw" => Ok(Packing::Plain),
        "gzip" | "gz" => Ok(Packing::Gzip),
        "ascii" | "text" | "txt" => Ok(Packing::Text),
        other => {
            let what = format!("its encoding {other:?} is not supported: save it as raw, gzip or ascii");
            Err(VolumeError::unsupported(path, what))
        }
    }
}

fn byte_order(header: &HeaderText, element: Element, packing: Packing) -> Result<ByteOrder, VolumeError> {
    match header.get(&["endian"]) {
        Some("little") => Ok(ByteOrder::Little),
        Some("big") => Ok(ByteOrder::Big),
        None if element.bytes() == 1 || packing == Packing::Text => Ok(ByteOrder::Little),
        Some(other) => Err(header.wrong(format!("`endian` is {other:?}, and must be little or big"))),
        None => {
            Err(header.wrong(format!("voxels of {element} need a line `endian: little` or `endian: big`")))
        }
    }
}
