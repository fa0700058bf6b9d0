//! The last slabs of one level of the octree while a store is built: its voxels, and what they stand for.

use super::ring::{Ring, kept};
use super::{BRICK_EDGE, BRICK_VOXELS, NodeKey, OVERLAP, OWN_EDGE, OctreeShape, StoreError};
use glam::UVec3;
use std::path::Path;

/// Edge of a tile of a slab: the own voxels of a brick.
pub(super) const TILE: usize = OWN_EDGE;

/// What a coarse voxel stands for, beside the mean.
pub(super) struct Spread {
    /// Smallest and largest value of the source.
    pub low: Ring,
    pub high: Ring,
    /// Variance of the source's values, where it is kept.
    pub variance: Option<Ring>,
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
    /// Of every kept slab, of each tile, x fastest: the value of all its voxels, or NaN where they differ.
    uniform: Vec<f32>,
}

/// A run of a brick's samples along x that lies in one tile.
struct Segment {
    tile: usize,
    first_sample: usize,
    first_voxel: usize,
    count: usize,
}

impl Level {
    /// All levels, finest first. What does not fit into `memory_bytes` is kept in files in `folder`, the finest level
    /// first: it is the largest.
    pub fn all(
        shape: OctreeShape,
        has_deviation: bool,
        memory_bytes: u64,
        folder: &Path,
    ) -> Result<Vec<Self>, StoreError> {
        let mut left = memory_bytes;
        let mut levels = Vec::new();
        for depth in 0..=shape.finest_depth() {
            let dims = shape.level_dims(depth);
            let is_finest = depth == shape.finest_depth();
            let rings = if is_finest { 1 } else { 3 + u64::from(has_deviation) };
            let bytes = rings * Ring::bytes(dims);
            let is_in_memory = bytes <= left;
            left -= if is_in_memory { bytes } else { 0 };
            let ring = || match is_in_memory {
                true => Ok(Ring::in_memory(dims)),
                false => Ring::in_file(dims, folder),
            };
            let spread = match is_finest {
                true => None,
                false => {
                    let variance = has_deviation.then(ring).transpose()?;
                    Some(Spread { low: ring()?, high: ring()?, variance })
                }
            };
            levels.push(Self::new(shape, depth, ring()?, spread));
        }
        levels.reverse();
        Ok(levels)
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

    /// The value of all voxels of a tile; NaN where they differ.
    pub fn uniform(&self, z: u32, tile_x: usize, tile_y: usize) -> f32 {
        self.uniform[self.uniform_start(z) + tile_y * self.tiles[0] + tile_x]
    }

    /// The room of a slab's means, and of its tiles' values.
    pub fn slab_mut(&mut self, z: u32) -> (&mut [f32], &mut [f32]) {
        let start = self.uniform_start(z);
        let tiles = self.tiles[0] * self.tiles[1];
        (self.means.slab_mut(z), &mut self.uniform[start..start + tiles])
    }

    /// The same with the slabs of the spread: low, high, variance.
    pub fn spread_mut(&mut self, z: u32) -> SpreadSlab<'_> {
        let start = self.uniform_start(z);
        let tiles = self.tiles[0] * self.tiles[1];
        let spread = self.spread.as_mut().expect("coarse levels have a spread");
        SpreadSlab {
            means: self.means.slab_mut(z),
            uniform: &mut self.uniform[start..start + tiles],
            low: spread.low.slab_mut(z),
            high: spread.high.slab_mut(z),
            variance: spread.variance.as_mut().map(|ring| ring.slab_mut(z)),
        }
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
        let segments = segments(node.cell.x, self.dims.x);
        let (first, last) = (&segments[0], &segments[segments.len() - 1]);
        let (start, end) = (first.first_sample, last.first_sample + last.count);
        let ys = sample_indices(node.cell.y, self.dims.y);
        samples.resize(BRICK_VOXELS, 0.0);
        let zs = sample_indices(node.cell.z, self.dims.z);
        for (plane, z) in samples.chunks_exact_mut(BRICK_EDGE * BRICK_EDGE).zip(zs) {
            for (out, y) in plane.chunks_exact_mut(BRICK_EDGE).zip(ys) {
                let row = ring.row(z as u32, y);
                for segment in &segments {
                    let out = &mut out[segment.first_sample..][..segment.count];
                    let uniform = self.uniform(z as u32, segment.tile, y / TILE);
                    match uniform.is_nan() {
                        true => out.copy_from_slice(&row[segment.first_voxel..][..segment.count]),
                        false => out.fill(of_uniform(uniform)),
                    }
                }
                let (before, after) = (out[start], out[end - 1]);
                out[..start].fill(before);
                out[end..].fill(after);
            }
        }
    }

    /// Voxels of the source that the voxels of a cell stand for along an axis that has so many of them.
    pub fn source_voxels(&self, cell: u32, source: u32) -> [f32; OWN_EDGE] {
        let first = cell * OWN_EDGE as u32;
        std::array::from_fn(|i| {
            let start = u64::from(first + i as u32) * u64::from(self.edge);
            let end = (start + u64::from(self.edge)).min(u64::from(source));
            end.saturating_sub(start) as f32
        })
    }
}

/// The room of a coarse slab.
pub(super) struct SpreadSlab<'a> {
    pub means: &'a mut [f32],
    pub uniform: &'a mut [f32],
    pub low: &'a mut [f32],
    pub high: &'a mut [f32],
    pub variance: Option<&'a mut [f32]>,
}

/// Voxels of the level at the 32 stored samples of a cell, along one axis.
fn sample_indices(cell: u32, voxels: u32) -> [usize; BRICK_EDGE] {
    let first = i64::from(cell) * OWN_EDGE as i64 - OVERLAP as i64;
    std::array::from_fn(|i| (first + i as i64).clamp(0, i64::from(voxels) - 1) as usize)
}

/// The samples of a cell that lie inside the level along x, tile by tile.
fn segments(cell: u32, voxels: u32) -> Vec<Segment> {
    let first = i64::from(cell) * OWN_EDGE as i64 - OVERLAP as i64;
    let (inside, end) = (first.max(0) as usize, (first + BRICK_EDGE as i64).min(i64::from(voxels)) as usize);
    let mut segments = Vec::new();
    let mut voxel = inside;
    while voxel < end {
        let tile = voxel / TILE;
        let count = ((tile + 1) * TILE).min(end) - voxel;
        let first_sample = (voxel as i64 - first) as usize;
        segments.push(Segment { tile, first_sample, first_voxel: voxel, count });
        voxel += count;
    }
    segments
}
