//! OME-Zarr 0.5 folders: one image, its levels as Zarr v3 arrays in packed chunks.

use super::grid;
use super::rounding::Rounding;
use super::supply::Supply;
use super::{ExportError, Part};
use bricks::BrickSource;
use bricks::volume::{ByteOrder, Element, Samples};
use bricks::working_folder::WorkingFolder;
use glam::{DVec3, UVec3};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Edge of a chunk.
const CHUNK_EDGE: u32 = 64;
/// Bytes of the voxels that are put together at once.
const MOST_TILE_BYTES: u64 = 1 << 30;
/// As fast as zstd packs while it still packs well: its own choice.
const ZSTD_LEVEL: i32 = 3;

/// Writes parts as the levels of an image; returns the bytes of all files.
pub(super) fn write(
    supply: Supply,
    parts: &[Part],
    element: Element,
    wrote: &dyn Fn(u32),
) -> Result<u64, ExportError> {
    let (out, failed) = (supply.out, ExportError::write(supply.out));
    let working = WorkingFolder::create(out).map_err(&failed)?;
    let mut bytes = 0;
    for (level, part) in parts.iter().enumerate() {
        let level = Level { folder: &working.path().join(level.to_string()), supply, part, element };
        bytes += level.write(wrote)?;
    }
    let name = out.file_stem().unwrap_or_default().to_string_lossy();
    bytes += write_json(working.path(), out, &group(supply.source, parts, &name))?;
    // A rename would replace an empty folder that somebody made meanwhile; nothing is lost with that.
    working.rename(out).map_err(failed)?;
    Ok(bytes)
}

/// One array being written.
struct Level<'a> {
    folder: &'a Path,
    supply: Supply<'a>,
    part: &'a Part,
    element: Element,
}

/// Chunks that are put together: the first one's place in the array, and how many there are.
struct Tile {
    first: UVec3,
    chunks: UVec3,
}

impl Level<'_> {
    fn write(&self, wrote: &dyn Fn(u32)) -> Result<u64, ExportError> {
        let (size, out) = (self.part.size, self.supply.out);
        fs::create_dir_all(self.folder).map_err(ExportError::write(out))?;
        let mut bytes = write_json(self.folder, out, &array(size, self.element))?;
        let rounding = Rounding::new(self.element);
        for tile in tiles(size, self.element) {
            let low = tile.first * CHUNK_EDGE;
            let end = ((tile.first + tile.chunks) * CHUNK_EDGE).min(size);
            let part = self.part.section(low, end - low);
            let samples = part.samples(self.supply, rounding)?;
            bytes += self.write_tile(&tile, &samples, part.size)?;
            let is_last_of_layer = end.x == size.x && end.y == size.y;
            if is_last_of_layer {
                wrote(end.z - low.z);
            }
        }
        Ok(bytes)
    }

    /// Packs and writes the chunks of a tile of these voxels; those of zeros alone are left out, as zero is the fill
    /// value.
    fn write_tile(&self, tile: &Tile, samples: &Samples, size: UVec3) -> Result<u64, ExportError> {
        let Tile { first, chunks } = *tile;
        let failed = ExportError::write(self.supply.out);
        let folder = self.folder.join("c").join(first.z.to_string());
        let write = |at: u32| -> Result<u64, ExportError> {
            self.supply.check_stop()?;
            let at = UVec3::new(at % chunks.x, at / chunks.x, 0);
            let chunk = self.chunk(samples, size, at * CHUNK_EDGE);
            if chunk.iter().all(|byte| *byte == 0) {
                return Ok(0);
            }
            let place = first + at;
            let row = folder.join(place.y.to_string());
            let write = || -> std::io::Result<u64> {
                let packed = zstd::bulk::compress(&chunk, ZSTD_LEVEL)?;
                fs::create_dir_all(&row)?;
                fs::write(row.join(place.x.to_string()), &packed)?;
                Ok(packed.len() as u64)
            };
            write().map_err(&failed)
        };
        (0..chunks.x * chunks.y).into_par_iter().map(write).sum()
    }

    /// The little-endian numbers of the chunk at `low` of some voxels; zeros beyond their end.
    fn chunk(&self, samples: &Samples, size: UVec3, low: UVec3) -> Vec<u8> {
        let (edge, bytes) = (CHUNK_EDGE, self.element.bytes());
        let end = (low + edge).min(size);
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

/// The chunks of an array, layer by layer, in tiles that fit into memory.
fn tiles(size: UVec3, element: Element) -> impl Iterator<Item = Tile> {
    let all = UVec3::from_array(size.to_array().map(|n| n.div_ceil(CHUNK_EDGE)));
    let chunk_bytes = u64::from(CHUNK_EDGE).pow(3) * element.bytes() as u64;
    let most = (MOST_TILE_BYTES / chunk_bytes) as u32;
    let columns = all.x.min(most);
    let rows = all.y.min(most / columns);
    let tile = move |x: u32, y: u32, z: u32| Tile {
        first: UVec3::new(x, y, z),
        chunks: UVec3::new(columns.min(all.x - x), rows.min(all.y - y), 1),
    };
    let row = move |y, z| (0..all.x).step_by(columns as usize).map(move |x| tile(x, y, z));
    (0..all.z).flat_map(move |z| (0..all.y).step_by(rows as usize).flat_map(move |y| row(y, z)))
}

fn write_json(folder: &Path, out: &Path, json: &Value) -> Result<u64, ExportError> {
    let text = format!("{json:#}\n");
    fs::write(folder.join("zarr.json"), &text).map_err(ExportError::write(out))?;
    Ok(text.len() as u64)
}

fn array(size: UVec3, element: Element) -> Value {
    let edge = CHUNK_EDGE;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_all_chunks_once_and_fit_into_memory() {
        for size in [
            UVec3::new(1, 1, 1),
            UVec3::new(64, 65, 200),
            UVec3::new(1 << 20, 700, 65),
            UVec3::new(5, 1 << 20, 1),
        ] {
            let mut chunks = std::collections::HashSet::new();
            for Tile { first, chunks: n } in tiles(size, Element::F64) {
                assert!(u64::from(n.element_product()) * (64 * 64 * 64 * 8) <= MOST_TILE_BYTES && n.z == 1);
                (0..n.x * n.y).for_each(|i| {
                    assert!(chunks.insert(first + UVec3::new(i % n.x, i / n.x, 0)));
                });
            }
            let all: usize = size.to_array().iter().map(|n| n.div_ceil(64) as usize).product();
            assert_eq!(chunks.len(), all, "{size}");
        }
    }
}
