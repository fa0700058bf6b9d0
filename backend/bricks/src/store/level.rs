//! The last slabs of one level of the octree while a store is built: its voxels, and what they stand for.

use super::StoreError;
use super::ring::{Budget, Ring, TILE, TileRow, kept};
use crate::{BRICK_EDGE, BRICK_VOXELS, NodeKey, OVERLAP, OWN_EDGE, OctreeShape};
use glam::UVec3;
use std::path::Path;

/// What a coarse voxel stands for, beside the mean.
pub(super) struct Spread {
    /// Smallest and largest value of the source.
    pub low: Ring,
    pub high: Ring,
    /// Standard deviation of the source's values, where it is kept.
    pub deviation: Option<Ring>,
}

/// A level's last slabs. A tile of a slab whose voxels are all equal is only known by that value, and its room in the
/// rings is not written: empty space costs neither memory nor time.
pub(super) struct Level {
    pub depth: u8,
    pub dims: UVec3,
    /// Edge of a voxel in voxels of the source.
    pub edge: u32,
    pub means: Ring,
    /// None at the finest level, whose voxels are the source's own.
    pub spread: Option<Spread>,
    tiles: [usize; 2],
    /// Of every kept slab, of each tile, x fastest: the value of all its voxels, or NaN if they differ.
    uniform: Vec<f32>,
}

/// A run of a brick's samples along x or y that lies in one tile.
struct Segment {
    tile: usize,
    first_sample: usize,
    /// In the tile.
    first_voxel: usize,
    count: usize,
}

impl Level {
    /// All levels, finest first. What does not fit into `memory_bytes` is kept in files in `folder`.
    pub fn all(
        shape: OctreeShape,
        has_deviation: bool,
        memory_bytes: u64,
        folder: &Path,
    ) -> Result<Vec<Self>, StoreError> {
        let rings = |depth| if depth == shape.finest_depth() { 1 } else { 3 + u64::from(has_deviation) };
        let depths = || (0..=shape.finest_depth()).rev();
        let most: u64 = depths().map(|depth| rings(depth) * Ring::bytes(shape.level_dims(depth))).sum();
        let budget = Budget::new(memory_bytes);
        let spill = (most > memory_bytes).then_some(folder);
        let level = |depth| {
            let ring = || Ring::new(shape.level_dims(depth), &budget, spill);
            let spread = match depth == shape.finest_depth() {
                true => None,
                false => {
                    let deviation = has_deviation.then(ring).transpose()?;
                    Some(Spread { low: ring()?, high: ring()?, deviation })
                }
            };
            Ok(Self::new(shape, depth, ring()?, spread))
        };
        depths().map(level).collect()
    }

    /// Bytes that the descriptions of a level's tiles take, whatever the tiles hold.
    pub fn tile_bytes(dims: UVec3) -> u64 {
        let tiles = [dims.x, dims.y].map(|n| u64::from(n).div_ceil(TILE as u64));
        let count = tiles[0].saturating_mul(tiles[1]).saturating_mul(u64::from(kept(dims)));
        count.saturating_mul(4 * Ring::TILE_BYTES + size_of::<f32>() as u64)
    }

    fn new(shape: OctreeShape, depth: u8, means: Ring, spread: Option<Spread>) -> Self {
        let dims = shape.level_dims(depth);
        let tiles = [dims.x, dims.y].map(|n| (n as usize).div_ceil(TILE));
        let uniform = vec![f32::NAN; tiles[0] * tiles[1] * kept(dims) as usize];
        Self { depth, dims, edge: 1 << shape.level(depth), means, spread, tiles, uniform }
    }

    /// Tiles along x and y.
    pub fn tiles(&self) -> [usize; 2] {
        self.tiles
    }

    /// Voxels of a tile along x.
    pub fn tile_width(&self, tile: usize) -> usize {
        TILE.min(self.dims.x as usize - tile * TILE)
    }

    fn uniform_start(&self, z: u32) -> usize {
        self.means.place(z) * self.tiles[0] * self.tiles[1]
    }

    /// The value of all voxels of a tile; NaN if they differ.
    pub fn uniform(&self, z: u32, tile_x: usize, tile_y: usize) -> f32 {
        self.uniform[self.uniform_start(z) + tile_y * self.tiles[0] + tile_x]
    }

    /// The room of a slab's means, and of its tiles' values, row of tiles by row of tiles.
    pub fn slab_mut(&mut self, z: u32) -> Vec<(TileRow<'_>, &mut [f32])> {
        let (start, across) = (self.uniform_start(z), self.tiles[0]);
        let uniform = self.uniform[start..start + across * self.tiles[1]].chunks_mut(across);
        self.means.slab_mut(z).into_iter().zip(uniform).collect()
    }

    /// The same with what coarse voxels stand for.
    pub fn spread_mut(&mut self, z: u32) -> Vec<SpreadRow<'_>> {
        let (start, across) = (self.uniform_start(z), self.tiles[0]);
        let spread = self.spread.as_mut().expect("coarse levels have a spread");
        let mut deviation = spread.deviation.as_mut().map(|ring| ring.slab_mut(z).into_iter());
        let rings =
            self.means.slab_mut(z).into_iter().zip(spread.low.slab_mut(z)).zip(spread.high.slab_mut(z));
        let uniform = self.uniform[start..start + across * self.tiles[1]].chunks_mut(across);
        let row = |(((means, low), high), uniform)| {
            let deviation = deviation.as_mut().and_then(Iterator::next);
            SpreadRow { uniform, means, low, high, deviation }
        };
        rings.zip(uniform).map(row).collect()
    }

    /// Layers of bricks (cells along z) that are complete once slab `z` is there, and were not before.
    pub fn layers_completed_by(&self, z: u32) -> impl Iterator<Item = u32> + use<> {
        let last_slab = self.dims.z - 1;
        let own = OWN_EDGE as u32;
        // Only the last layers may end with the same slab.
        let first = (z.saturating_sub(OVERLAP as u32 - 1) / own).saturating_sub(1);
        (first..self.dims.z.div_ceil(own).min(first + 4))
            .filter(move |layer| (layer * own + own + OVERLAP as u32 - 1).min(last_slab) == z)
    }

    /// Nodes of a layer.
    pub fn layer_nodes(&self, layer: u32) -> Vec<NodeKey> {
        let row = |y| (0..self.tiles[0]).map(move |x| UVec3::new(x as u32, y, layer));
        let cells = (0..self.tiles[1] as u32).flat_map(row);
        cells.map(|cell| NodeKey { depth: self.depth, cell }).collect()
    }

    /// The value of all stored samples of a node of a complete layer, where whole tiles show that they are equal.
    pub fn uniform_brick(&self, node: NodeKey) -> Option<f32> {
        let around = |axis: usize| {
            let cell = node.cell[axis] as usize;
            cell.saturating_sub(1)..=(cell + 1).min(self.tiles[axis] - 1)
        };
        let zs = sample_indices(node.cell.z, self.dims.z);
        let value = self.uniform(zs[0] as u32, *around(0).start(), *around(1).start());
        let all = (zs[0]..=zs[BRICK_EDGE - 1])
            .all(|z| around(1).all(|y| around(0).all(|x| self.uniform(z as u32, x, y) == value)));
        all.then_some(value)
    }

    /// The stored samples of a node of a complete layer: beyond the level's extent its edge repeats. `ring` is one of
    /// the level's, and `of_uniform` its number for a tile of one value.
    pub fn samples(
        &self,
        node: NodeKey,
        ring: &Ring,
        of_uniform: impl Fn(f32) -> f32,
        samples: &mut Vec<f32>,
    ) {
        let [xs, ys] = [0, 1].map(|axis| segments(node.cell[axis], self.dims[axis]));
        samples.resize(BRICK_VOXELS, 0.0);
        let zs = sample_indices(node.cell.z, self.dims.z);
        for (plane, z) in samples.chunks_exact_mut(BRICK_EDGE * BRICK_EDGE).zip(zs) {
            for y in &ys {
                for x in &xs {
                    let uniform = self.uniform(z as u32, x.tile, y.tile);
                    match uniform.is_nan() {
                        true => copy_tile(
                            ring.tile(z as u32, x.tile, y.tile),
                            self.tile_width(x.tile),
                            x,
                            y,
                            plane,
                        ),
                        false => fill(of_uniform(uniform), x, y, plane),
                    }
                }
            }
            repeat_edges(&xs, &ys, plane);
        }
    }

    /// Voxels of the source that the voxels of a cell stand for along an axis that has so many of them.
    pub fn source_voxels(&self, cell: u32, source: u32) -> [f32; OWN_EDGE] {
        let first = cell * OWN_EDGE as u32;
        std::array::from_fn(|i| covered(first + i as u32, self.edge, source) as f32)
    }
}

/// Voxels of the source that voxel `i` of a level, of so many of them along an edge, covers along an axis; none where
/// the source has ended before.
pub(super) fn covered(i: u32, edge: u32, source: u32) -> u32 {
    let start = u64::from(i) * u64::from(edge);
    let end = (start + u64::from(edge)).min(u64::from(source));
    end.saturating_sub(start) as u32
}

/// Copies what a brick has of a tile into a plane of its samples.
fn copy_tile(tile: &[f32], width: usize, x: &Segment, y: &Segment, plane: &mut [f32]) {
    let rows = tile.chunks_exact(width).skip(y.first_voxel);
    let out = plane.chunks_exact_mut(BRICK_EDGE).skip(y.first_sample).take(y.count);
    for (out, row) in out.zip(rows) {
        let (out, row) = (&mut out[x.first_sample..][..x.count], &row[x.first_voxel..][..x.count]);
        copy_row(row, out);
    }
}

/// Copies a row; lengths that the compiler knows need no call.
pub(super) fn copy_row(row: &[f32], out: &mut [f32]) {
    match out.len() {
        OWN_EDGE => out[..OWN_EDGE].copy_from_slice(&row[..OWN_EDGE]),
        OVERLAP => out[..OVERLAP].copy_from_slice(&row[..OVERLAP]),
        _ => out.copy_from_slice(row),
    }
}

fn fill(value: f32, x: &Segment, y: &Segment, plane: &mut [f32]) {
    for out in plane.chunks_exact_mut(BRICK_EDGE).skip(y.first_sample).take(y.count) {
        out[x.first_sample..][..x.count].fill(value);
    }
}

/// Repeats the edges of what lies inside the level up to the plane's ends.
fn repeat_edges(xs: &[Segment], ys: &[Segment], plane: &mut [f32]) {
    let ends = |segments: &[Segment]| {
        let last = &segments[segments.len() - 1];
        (segments[0].first_sample, last.first_sample + last.count)
    };
    let ((left, right), (top, bottom)) = (ends(xs), ends(ys));
    if right - left < BRICK_EDGE {
        for row in plane.chunks_exact_mut(BRICK_EDGE).take(bottom).skip(top) {
            let (before, after) = (row[left], row[right - 1]);
            row[..left].fill(before);
            row[right..].fill(after);
        }
    }
    for y in (0..top).chain(bottom..BRICK_EDGE) {
        let edge = y.clamp(top, bottom - 1) * BRICK_EDGE;
        plane.copy_within(edge..edge + BRICK_EDGE, y * BRICK_EDGE);
    }
}

/// The room of a row of tiles of a coarse slab.
pub(super) struct SpreadRow<'a> {
    pub uniform: &'a mut [f32],
    pub means: TileRow<'a>,
    pub low: TileRow<'a>,
    pub high: TileRow<'a>,
    pub deviation: Option<TileRow<'a>>,
}

/// Voxels of the level at the 32 stored samples of a cell, along one axis.
fn sample_indices(cell: u32, voxels: u32) -> [usize; BRICK_EDGE] {
    let first = i64::from(cell) * OWN_EDGE as i64 - OVERLAP as i64;
    std::array::from_fn(|i| (first + i as i64).clamp(0, i64::from(voxels) - 1) as usize)
}

/// The samples of a cell that lie inside the level along an axis, tile by tile.
fn segments(cell: u32, voxels: u32) -> Vec<Segment> {
    let first = i64::from(cell) * OWN_EDGE as i64 - OVERLAP as i64;
    let (inside, end) = (first.max(0) as usize, (first + BRICK_EDGE as i64).min(i64::from(voxels)) as usize);
    let mut segments = Vec::new();
    let mut voxel = inside;
    while voxel < end {
        let tile = voxel / TILE;
        let count = ((tile + 1) * TILE).min(end) - voxel;
        let first_sample = (voxel as i64 - first) as usize;
        segments.push(Segment { tile, first_sample, first_voxel: voxel % TILE, count });
        voxel += count;
    }
    segments
}
