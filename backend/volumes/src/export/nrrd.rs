//! NRRD files, with the voxels in them.

use super::grid;
use super::numbers::Rounding;
use super::{ExportError, Part};
use bricks::BrickSource;
use bricks::temporary::temporary_in;
use bricks::volume::{ByteOrder, Element, Space, VolumeFrame};
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::DVec3;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Bytes collected before they are written.
const WRITE_BUFFER_BYTES: usize = 1 << 20;

/// Writes a part; returns the file's bytes.
pub(super) fn write(
    source: &dyn BrickSource,
    part: &Part,
    element: Element,
    out: &Path,
    is_packed: bool,
    wrote: &dyn Fn(u32),
) -> Result<u64, ExportError> {
    let failed = ExportError::write(out);
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = temporary_in(folder).map_err(&failed)?;
    let mut writer = BufWriter::with_capacity(WRITE_BUFFER_BYTES, file.as_file_mut());
    let header = header(&grid::frame(source, part), part, element, is_packed);
    writer.write_all(header.as_bytes()).map_err(&failed)?;
    match is_packed {
        false => write_voxels(source, part, element, out, &mut writer, wrote)?,
        true => {
            let mut packed = GzEncoder::new(&mut writer, Compression::default());
            write_voxels(source, part, element, out, &mut packed, wrote)?;
            packed.finish().map_err(&failed)?;
        }
    }
    writer.flush().map_err(&failed)?;
    drop(writer);
    file.as_file().sync_all().map_err(&failed)?;
    let bytes = file.as_file().metadata().map_err(&failed)?.len();
    file.persist(out).map_err(|error| failed(error.error))?;
    Ok(bytes)
}

fn write_voxels(
    source: &dyn BrickSource,
    part: &Part,
    element: Element,
    out: &Path,
    writer: &mut dyn Write,
    wrote: &dyn Fn(u32),
) -> Result<(), ExportError> {
    let rounding = Rounding::new(element);
    for z in part.layers() {
        let mut samples = part.planes(z.clone()).samples(source, rounding)?;
        samples.reorder(ByteOrder::Little);
        writer.write_all(samples.bytes()).map_err(ExportError::write(out))?;
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
