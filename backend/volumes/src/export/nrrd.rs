//! NRRD files, with the voxels in them.

use super::grid;
use super::rounding::Rounding;
use super::supply::Supply;
use super::{ExportError, Part};
use bricks::OWN_EDGE;
use bricks::volume::{ByteOrder, Element, Space, VolumeFrame};
use bricks::working_file::WorkingFile;
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;
use std::io::{BufWriter, Write};

/// Bytes collected before they are written.
const WRITE_BUFFER_BYTES: usize = 1 << 20;
/// Bytes of the planes that are put together at once, if one plane has no more.
const MOST_LAYER_BYTES: u64 = 1 << 30;
/// Voxels of the largest plane: planes are written one after the other, so each is in memory.
const MOST_PLANE_VOXELS: u64 = 1 << 29;

/// Refuses a part of which no plane can be put together.
pub(super) fn check_size(part: &Part) -> Result<(), ExportError> {
    match plane_voxels(part) <= MOST_PLANE_VOXELS {
        true => Ok(()),
        false => Err(ExportError::Plane { width: part.size.x, height: part.size.y }),
    }
}

fn plane_voxels(part: &Part) -> u64 {
    u64::from(part.size.x) * u64::from(part.size.y)
}

/// Writes a part; returns the file's bytes.
pub(super) fn write(
    supply: Supply,
    part: &Part,
    element: Element,
    is_packed: bool,
    wrote: &dyn Fn(u32),
) -> Result<u64, ExportError> {
    let failed = ExportError::write(supply.out);
    let (working, file) = WorkingFile::create(supply.out).map_err(&failed)?;
    let mut writer = BufWriter::with_capacity(WRITE_BUFFER_BYTES, &file);
    let header = header(&grid::frame(supply.source, part), part, element, is_packed);
    writer.write_all(header.as_bytes()).map_err(&failed)?;
    match is_packed {
        false => write_voxels(supply, part, element, &mut writer, wrote)?,
        true => {
            let mut packed = GzEncoder::new(&mut writer, Compression::default());
            write_voxels(supply, part, element, &mut packed, wrote)?;
            packed.finish().map_err(&failed)?;
        }
    }
    writer.flush().map_err(&failed)?;
    drop(writer);
    file.sync_all().map_err(&failed)?;
    let bytes = file.metadata().map_err(&failed)?.len();
    working.rename(supply.out).map_err(failed)?;
    Ok(bytes)
}

fn write_voxels(
    supply: Supply,
    part: &Part,
    element: Element,
    writer: &mut dyn Write,
    wrote: &dyn Fn(u32),
) -> Result<(), ExportError> {
    let rounding = Rounding::new(element);
    let fitting = MOST_LAYER_BYTES / (plane_voxels(part) * element.bytes() as u64);
    // At least a plane, at most a layer of bricks.
    for z in part.layers(fitting.clamp(1, OWN_EDGE as u64) as u32) {
        let mut samples = part.planes(z.clone()).samples(supply, rounding)?;
        samples.reorder(ByteOrder::Little);
        writer.write_all(samples.bytes()).map_err(ExportError::write(supply.out))?;
        wrote(z.end - z.start);
    }
    Ok(())
}

fn header(frame: &VolumeFrame, part: &Part, element: Element, is_packed: bool) -> String {
    let name = match element {
        Element::F32 => "float".to_owned(),
        Element::F64 => "double".to_owned(),
        integer => integer.to_string(),
    };
    let space = match frame.space {
        Space::Patient => "space: left-posterior-superior",
        Space::Unknown => "space dimension: 3",
    };
    let encoding = if is_packed { "gzip" } else { "raw" };
    let [x, y, z] = part.size.to_array();
    let [i, j, k] = [frame.axes_m.x_axis, frame.axes_m.y_axis, frame.axes_m.z_axis].map(millimetres);
    let origin = millimetres(frame.origin_m);
    format!(
        "NRRD0004\ntype: {name}\ndimension: 3\n{space}\nsizes: {x} {y} {z}\n\
         space directions: {i} {j} {k}\nkinds: domain domain domain\nendian: little\n\
         encoding: {encoding}\nspace units: \"mm\" \"mm\" \"mm\"\nspace origin: {origin}\n\n"
    )
}

fn millimetres(v: DVec3) -> String {
    // Adding 0 makes a zero of −0, which reads better.
    let v = v * 1e3 + 0.0;
    format!("({},{},{})", v.x, v.y, v.z)
}
