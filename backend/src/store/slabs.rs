//! The last slabs of one level: enough for a layer of bricks, the rest of the level is forgotten.

use super::{BRICK_EDGE, NodeKey, OVERLAP, OWN_EDGE, OctreeShape, StoreError};
use glam::UVec3;
use memmap2::MmapMut;
use rayon::prelude::*;
use std::io::Write;
use std::path::Path;

/// Zeros written at once to a working file.
static ZEROS: [u8; 1 << 16] = [0; 1 << 16];

/// Where slabs are kept: in memory, or in a nameless file that the system pages in and out.
enum Memory {
    Heap(Vec<f32>),
    Mapped(MmapMut),
}

impl Memory {
    fn values(&self) -> &[f32] {
        match self {
            Memory::Heap(values) => values,
            Memory::Mapped(map) => bytemuck::cast_slice(map),
        }
    }

    fn values_mut(&mut self) -> &mut [f32] {
        match self {
            Memory::Heap(values) => values,
            Memory::Mapped(map) => bytemuck::cast_slice_mut(map),
        }
    }

    /// A mapped file whose every byte is on the disk already: a disk that fills up is an error here, and would be a
    /// crash at a page written later.
    fn mapped(folder: &Path, values: usize) -> Result<Self, StoreError> {
        let mut file = tempfile::tempfile_in(folder).map_err(StoreError::write(folder))?;
        let mut left = values * size_of::<f32>();
        while left > 0 {
            let part = left.min(ZEROS.len());
            file.write_all(&ZEROS[..part]).map_err(StoreError::write(folder))?;
            left -= part;
        }
        // SAFETY: the file has no name, so no other process can change or cut it.
        let map = unsafe { MmapMut::map_mut(&file) }.map_err(StoreError::write(folder))?;
        Ok(Memory::Mapped(map))
    }
}

/// A ring of the slabs of a level, [`BRICK_EDGE`] of them or the level's height.
pub(super) struct LevelSlabs {
    depth: u8,
    dims: UVec3,
    kept: u32,
    memory: Memory,
}

impl LevelSlabs {
    /// The rings of all levels, finest first, in memory where they fit `memory_bytes`, else in files in `folder`.
    pub fn all(shape: OctreeShape, memory_bytes: u64, folder: &Path) -> Result<Vec<Self>, StoreError> {
        let depths = || (0..=shape.finest_depth()).rev();
        let bytes: u64 =
            depths().map(|depth| ring_values(shape, depth) as u64 * size_of::<f32>() as u64).sum();
        let ring = |depth| {
            let dims = shape.level_dims(depth);
            let values = ring_values(shape, depth);
            let memory = if bytes <= memory_bytes {
                Memory::Heap(vec![0.0; values])
            } else {
                Memory::mapped(folder, values)?
            };
            Ok(Self { depth, dims, kept: kept(dims), memory })
        };
        depths().map(ring).collect()
    }

    /// Voxels of the level along each axis.
    pub fn dims(&self) -> UVec3 {
        self.dims
    }

    fn slab_range(&self, z: u32) -> std::ops::Range<usize> {
        let voxels = self.dims.x as usize * self.dims.y as usize;
        let start = (z % self.kept) as usize * voxels;
        start..start + voxels
    }

    /// A slab among the last ones written.
    fn slab(&self, z: u32) -> &[f32] {
        &self.memory.values()[self.slab_range(z)]
    }

    /// The place of a slab; it takes that of the slab [`BRICK_EDGE`] before.
    pub fn slab_mut(&mut self, z: u32) -> &mut [f32] {
        let range = self.slab_range(z);
        &mut self.memory.values_mut()[range]
    }

    /// Layers of bricks (cells along z) that are complete once slab `z` is there, and were not before.
    pub fn layers_completed_by(&self, z: u32) -> impl Iterator<Item = u32> + use<> {
        let last_slab = self.dims.z - 1;
        let own = OWN_EDGE as u32;
        (0..self.dims.z.div_ceil(own))
            .filter(move |layer| (layer * own + own + OVERLAP as u32 - 1).min(last_slab) == z)
    }

    /// Nodes of a layer.
    pub fn layer_nodes(&self, layer: u32) -> Vec<NodeKey> {
        let bricks = self.dims.map(|n| n.div_ceil(OWN_EDGE as u32));
        let row =
            |y| (0..bricks.x).map(move |x| NodeKey { depth: self.depth, cell: UVec3::new(x, y, layer) });
        (0..bricks.y).flat_map(row).collect()
    }

    /// The stored samples of a node of a complete layer: beyond the level's extent its edge repeats.
    pub fn samples(&self, node: NodeKey) -> Vec<f32> {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| sample_indices(node.cell[axis], self.dims[axis]));
        let width = self.dims.x as usize;
        let mut samples = Vec::with_capacity(BRICK_EDGE * BRICK_EDGE * BRICK_EDGE);
        for z in zs {
            let slab = self.slab(z as u32);
            for y in ys {
                let row = &slab[y * width..(y + 1) * width];
                match xs[BRICK_EDGE - 1] - xs[0] + 1 {
                    BRICK_EDGE => samples.extend_from_slice(&row[xs[0]..][..BRICK_EDGE]),
                    _ => samples.extend(xs.iter().map(|&x| row[x])),
                }
            }
        }
        samples
    }

    /// Writes the slab of the next coarser level that ends with this level's slab `z`: means over the 2 × 2 × 2
    /// voxels of this level, at its end over those that exist.
    pub fn halve(&self, z: u32, coarse: &mut [f32]) {
        let (width, height) = (self.dims.x as usize, self.dims.y as usize);
        let slabs: Vec<_> = (z & !1..=z).map(|z| self.slab(z)).collect();
        coarse.par_chunks_mut(width.div_ceil(2)).enumerate().for_each(|(y, coarse_row)| {
            let ys = 2 * y..(2 * y + 2).min(height);
            let rows: Vec<_> =
                slabs.iter().flat_map(|slab| ys.clone().map(move |y| &slab[y * width..][..width])).collect();
            for (x, mean) in coarse_row.iter_mut().enumerate() {
                let xs = 2 * x..(2 * x + 2).min(width);
                let sum: f64 =
                    rows.iter().flat_map(|row| &row[xs.clone()]).map(|&value| f64::from(value)).sum();
                *mean = (sum / (rows.len() * xs.len()) as f64) as f32;
            }
        });
    }
}

fn kept(dims: UVec3) -> u32 {
    dims.z.min(BRICK_EDGE as u32)
}

fn ring_values(shape: OctreeShape, depth: u8) -> usize {
    let dims = shape.level_dims(depth);
    dims.x as usize * dims.y as usize * kept(dims) as usize
}

/// Voxels of the level at the 32 stored samples of a cell, along one axis.
fn sample_indices(cell: u32, voxels: u32) -> [usize; BRICK_EDGE] {
    let first = i64::from(cell) * OWN_EDGE as i64 - OVERLAP as i64;
    std::array::from_fn(|i| (first + i as i64).clamp(0, i64::from(voxels) - 1) as usize)
}
