//! OME-Zarr 0.5 folders: one image, its levels as Zarr v3 arrays in packed chunks.

use super::grid;
use super::rounding::Rounding;
use super::{ExportError, Part};
use bricks::BrickSource;
use bricks::temporary::temporary_folder_in;
use bricks::volume::{ByteOrder, Element, Samples};
use glam::{DVec3, UVec3};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Edge of a chunk, if memory suffices, and if a layer of such chunks would be larger than the next constant.
const CHUNK_EDGES: [u32; 2] = [64, 32];
/// Largest layer of the large chunks.
const MOST_LAYER_BYTES: u64 = 1 << 30;
/// As fast as zstd packs while it still packs well: its own choice.
const ZSTD_LEVEL: i32 = 3;

/// Writes parts as the levels of an image; returns the bytes of all files.
pub(super) fn write(
    source: &dyn BrickSource,
    parts: &[Part],
    element: Element,
    out: &Path,
    wrote: &dyn Fn(u32),
) -> Result<u64, ExportError> {
    let failed = ExportError::write(out);
    let beside = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let working = temporary_folder_in(beside).map_err(&failed)?;
    let mut bytes = 0;
    for (level, part) in parts.iter().enumerate() {
        let level = Level { folder: &working.path().join(level.to_string()), out, part, element };
        bytes += level.write(source, wrote)?;
    }
    let name = out.file_stem().unwrap_or_default().to_string_lossy();
    bytes += write_json(working.path(), out, &group(source, parts, &name))?;
    // A rename would replace an empty folder that somebody made meanwhile; nothing is lost with that.
    fs::rename(working.path(), out).map_err(&failed)?;
    // What it would delete now has another name.
    let _ = working.keep();
    Ok(bytes)
}

/// One array being written.
struct Level<'a> {
    folder: &'a Path,
    /// What the errors name.
    out: &'a Path,
    part: &'a Part,
    element: Element,
}

impl Level<'_> {
    fn write(&self, source: &dyn BrickSource, wrote: &dyn Fn(u32)) -> Result<u64, ExportError> {
        let size = self.part.size;
        let edge = chunk_edge(size, self.element);
        fs::create_dir_all(self.folder).map_err(ExportError::write(self.out))?;
        let mut bytes = write_json(self.folder, self.out, &array(size, self.element, edge))?;
        let rounding = Rounding::new(self.element);
        for layer in 0..size.z.div_ceil(edge) {
            let z = layer * edge..((layer + 1) * edge).min(size.z);
            let samples = self.part.planes(z.clone()).samples(source, rounding)?;
            bytes += self.write_layer(layer, edge, &samples, z.end - z.start)?;
            wrote(z.end - z.start);
        }
        Ok(bytes)
    }

    /// Packs and writes the chunks of a layer; those of zeros alone are left out, as zero is the fill value.
    fn write_layer(&self, layer: u32, edge: u32, samples: &Samples, planes: u32) -> Result<u64, ExportError> {
        let (x, y) = (self.part.size.x.div_ceil(edge), self.part.size.y.div_ceil(edge));
        let failed = ExportError::write(self.out);
        let folder = self.folder.join("c").join(layer.to_string());
        let write = |at: u32| -> std::io::Result<u64> {
            let (i, j) = (at % x, at / x);
            let chunk = self.chunk(samples, planes, edge, UVec3::new(i, j, 0) * edge);
            if chunk.iter().all(|byte| *byte == 0) {
                return Ok(0);
            }
            let packed = zstd::bulk::compress(&chunk, ZSTD_LEVEL)?;
            let row = folder.join(j.to_string());
            fs::create_dir_all(&row)?;
            fs::write(row.join(i.to_string()), &packed)?;
            Ok(packed.len() as u64)
        };
        (0..x * y).into_par_iter().map(write).sum::<std::io::Result<u64>>().map_err(failed)
    }

    /// The little-endian numbers of a chunk that starts at `low` of the layer; zeros beyond the level's end.
    fn chunk(&self, samples: &Samples, planes: u32, edge: u32, low: UVec3) -> Vec<u8> {
        let (size, bytes) = (self.part.size, self.element.bytes());
        let end = (low + edge).min(UVec3::new(size.x, size.y, planes));
        let mut chunk = Samples::new(self.element, (edge * edge * edge) as usize);
        for z in low.z..end.z {
            for y in low.y..end.y {
                let from = ((z as usize * size.y as usize) + y as usize) * size.x as usize + low.x as usize;
                let to = (((z - low.z) * edge + y - low.y) * edge) as usize;
                let run = bytes * (end.x - low.x) as usize;
                chunk.bytes_mut()[to * bytes..][..run]
                    .copy_from_slice(&samples.bytes()[from * bytes..][..run]);
            }
        }
        chunk.reorder(ByteOrder::Little);
        chunk.bytes().to_vec()
    }
}

fn chunk_edge(size: UVec3, element: Element) -> u32 {
    let plane_bytes = u64::from(size.x) * u64::from(size.y) * element.bytes() as u64;
    let [large, small] = CHUNK_EDGES;
    if plane_bytes * u64::from(large) <= MOST_LAYER_BYTES { large } else { small }
}

fn write_json(folder: &Path, out: &Path, json: &Value) -> Result<u64, ExportError> {
    let text = format!("{json:#}\n");
    fs::write(folder.join("zarr.json"), &text).map_err(ExportError::write(out))?;
    Ok(text.len() as u64)
}

fn array(size: UVec3, element: Element, edge: u32) -> Value {
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": [size.z, size.y, size.x],
        "data_type": element.to_string(),
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": [edge, edge, edge] } },
        "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
        "fill_value": if element.is_float() { json!(0.0) } else { json!(0) },
        "codecs": [
            { "name": "bytes", "configuration": { "endian": "little" } },
            { "name": "zstd", "configuration": { "level": ZSTD_LEVEL, "checksum": false } },
        ],
        "dimension_names": ["z", "y", "x"],
        "attributes": {},
    })
}

fn group(source: &dyn BrickSource, parts: &[Part], name: &str) -> Value {
    let axis = |name| json!({ "name": name, "type": "space", "unit": "millimeter" });
    let zyx = |v: DVec3| json!([1e3 * v.z, 1e3 * v.y, 1e3 * v.x]);
    let dataset = |(level, part): (usize, &Part)| {
        let (size, first) = grid::upright(source, part);
        json!({
            "path": level.to_string(),
            "coordinateTransformations": [
                { "type": "scale", "scale": zyx(size) },
                { "type": "translation", "translation": zyx(first) },
            ],
        })
    };
    let datasets: Vec<_> = parts.iter().enumerate().map(dataset).collect();
    let image = json!({
        "name": name,
        "axes": [axis("z"), axis("y"), axis("x")],
        "datasets": datasets,
        "type": "mean",
    });
    let ome = json!({ "version": "0.5", "multiscales": [image] });
    json!({ "zarr_format": 3, "node_type": "group", "attributes": { "ome": ome } })
}
