//! NRRD headers (.nrrd with the voxels inside, .nhdr with a file of voxels beside it).

use super::file::{FileLayout, Packing, file_length};
use super::header_text::{HeaderText, Line};
use super::{ByteOrder, Element, VolumeError, VolumeFrame};
use glam::DVec3;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Names of the field that says where the voxels are.
const DATA_FILE: [&str; 2] = ["data file", "datafile"];

/// Reads the header. Lengths are millimetres unless `space units` or `units` say otherwise.
pub(super) fn layout(path: &Path) -> Result<FileLayout, VolumeError> {
    let header = HeaderText::read(path, line)?;
    if header.need("dimension")? != "3" {
        let what = "it does not have three axes (dimension): save one volume of it";
        return Err(VolumeError::unsupported(path, what));
    }
    let element = element(path, &header)?;
    let dims = header.dims("sizes", header.need("sizes")?)?;
    let packing = packing(path, &header)?;
    let voxels: u64 = dims.to_array().map(u64::from).iter().fold(1, |n, &edge| n.saturating_mul(edge));
    let bytes = voxels.saturating_mul(element.bytes() as u64);
    let place = place(path, &header, packing, bytes)?;
    Ok(FileLayout {
        header_path: path.into(),
        data_path: place.path,
        dims,
        frame: VolumeFrame::of_voxels(voxel_size_m(&header)?),
        element,
        byte_order: byte_order(&header, element)?,
        packing,
        file_offset: place.file_offset,
        data_offset: place.data_offset,
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
    if text.starts_with('#') || text.contains(":=") {
        return Line::Ignored;
    }
    match text.split_once(": ") {
        Some((key, value)) => Line::Field(key.trim().into(), value.into()),
        None => Line::Wrong,
    }
}

fn element(path: &Path, header: &HeaderText) -> Result<Element, VolumeError> {
    let name = header.need("type")?;
    Element::from_name(name).ok_or_else(|| {
        VolumeError::unsupported(
            path,
            format!("its type {name:?} is not supported: save it as short or float"),
        )
    })
}

fn packing(path: &Path, header: &HeaderText) -> Result<Packing, VolumeError> {
    match header.need("encoding")?.to_ascii_lowercase().as_str() {
        "raw" => Ok(Packing::Plain),
        "gzip" | "gz" => Ok(Packing::Gzip),
        other => Err(VolumeError::unsupported(
            path,
            format!("its encoding {other:?} is not supported: save it as raw or gzip"),
        )),
    }
}

fn byte_order(header: &HeaderText, element: Element) -> Result<ByteOrder, VolumeError> {
    match header.get(&["endian"]) {
        Some("little") => Ok(ByteOrder::Little),
        Some("big") => Ok(ByteOrder::Big),
        Some(other) => Err(header.wrong(format!("`endian` is {other:?}, and must be little or big"))),
        None if element.bytes() == 1 => Ok(ByteOrder::Little),
        None => {
            Err(header.wrong(format!("voxels of {element} need a line `endian: little` or `endian: big`")))
        }
    }
}

struct Place {
    path: PathBuf,
    file_offset: u64,
    data_offset: u64,
}

/// The file with the voxels and what precedes them there: lines, then bytes (after unpacking).
fn place(path: &Path, header: &HeaderText, packing: Packing, bytes: u64) -> Result<Place, VolumeError> {
    let (data_path, start) = match header.get(&DATA_FILE) {
        None => (path.to_path_buf(), header.length),
        Some(name) if name.starts_with("LIST") || name.contains('%') => {
            return Err(VolumeError::unsupported(path, "its slices are separate files: save it as one file"));
        }
        Some("") => return Err(header.wrong("`data file` is empty, and must be the name of a file")),
        Some(name) => (header.beside(name), 0),
    };
    let lines = match header.get(&["line skip", "lineskip"]) {
        Some(value) => header.number("line skip", value)?,
        None => 0,
    };
    let file_offset = start + lines_length(&data_path, start, lines)?;
    let skip: i64 = match header.get(&["byte skip", "byteskip"]) {
        Some(value) => header.number("byte skip", value)?,
        None => 0,
    };
    match (u64::try_from(skip), packing) {
        (Ok(skip), _) => Ok(Place { path: data_path, file_offset, data_offset: skip }),
        (Err(_), Packing::Plain) if skip == -1 => {
            let file_offset = file_length(&data_path)?.saturating_sub(bytes);
            Ok(Place { path: data_path, file_offset, data_offset: 0 })
        }
        _ => Err(header.wrong(format!("`byte skip` is {skip}, and negative only as -1 with raw encoding"))),
    }
}

/// Bytes of the first `lines` lines after `start`.
fn lines_length(path: &Path, start: u64, lines: u32) -> Result<u64, VolumeError> {
    if lines == 0 {
        return Ok(0);
    }
    let mut file = BufReader::new(File::open(path).map_err(VolumeError::open(path))?);
    let mut length = 0;
    file.seek_relative(start as i64).map_err(VolumeError::read(path))?;
    for _ in 0..lines {
        length += file.skip_until(b'\n').map_err(VolumeError::read(path))? as u64;
    }
    Ok(length)
}

/// Edge lengths from `space directions` (their lengths) or `spacings`; 1 mm where neither is given or known.
fn voxel_size_m(header: &HeaderText) -> Result<DVec3, VolumeError> {
    if let Some(value) = header.get(&["space directions"]) {
        let units_m = units_m(header, "space units")?;
        let vectors = directions(header, value)?;
        return Ok(DVec3::from_array(vectors.map(|vector| (vector * units_m).length())));
    }
    let units_m = units_m(header, "units")?;
    let spacings = match header.get(&["spacings"]) {
        Some(value) => header.lengths("spacings", value)?.abs(),
        None => DVec3::ONE,
    };
    Ok(DVec3::select(spacings.is_nan_mask(), DVec3::ONE, spacings) * units_m)
}

/// Three vectors, written as `(1,0,0) (0,1,0) (0,0,2)`.
fn directions(header: &HeaderText, value: &str) -> Result<[DVec3; 3], VolumeError> {
    let key = "space directions";
    let vectors = value
        .split(')')
        .map(|part| part.trim().trim_start_matches('('))
        .filter(|part| !part.is_empty())
        .map(|part| header.lengths(key, &part.replace(',', " ")))
        .collect::<Result<Vec<_>, _>>()?;
    vectors
        .try_into()
        .map_err(|_| header.wrong(format!("`{key}` is {value:?}, and three vectors are expected")))
}

/// Metres per unit of each axis, from a list of quoted names.
fn units_m(header: &HeaderText, key: &str) -> Result<DVec3, VolumeError> {
    let Some(value) = header.get(&[key]) else { return Ok(DVec3::splat(1e-3)) };
    let mut units = [1e-3; 3];
    let names = value.split('"').skip(1).step_by(2);
    for (unit, name) in units.iter_mut().zip(names) {
        *unit = unit_m(name).ok_or_else(|| header.wrong(format!("`{key}` has the unknown unit {name:?}")))?;
    }
    Ok(DVec3::from_array(units))
}

fn unit_m(name: &str) -> Option<f64> {
    Some(match name.trim() {
        "" | "mm" | "millimeter" | "millimeters" | "millimetre" => 1e-3,
        "m" | "meter" | "meters" | "metre" => 1.0,
        "cm" | "centimeter" | "centimetre" => 1e-2,
        "um" | "µm" | "μm" | "micron" | "microns" | "micrometer" | "micrometre" => 1e-6,
        "nm" | "nanometer" | "nanometre" => 1e-9,
        _ => return None,
    })
}
