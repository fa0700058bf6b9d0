//! Decoded planes of constant z: how many at once, and how chunks are put into them.

use super::array::Block;
use super::axes::Axes;
use std::ops::Range;

/// Chunks that are worth decoding in parallel.
const UNITS_AT_ONCE: u64 = 16;

/// How the planes are grouped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grouping {
    /// Planes decoded together, at most.
    pub planes: u64,
    /// Groups start again at multiples of this, where a chunk starts.
    pub period: u64,
}

impl Grouping {
    /// The grouping of `dims_z` planes in chunks of `unit_z`, `units` of them side by side, where a plane takes
    /// `plane_bytes` of the `budget_bytes`: whole chunks, and thin ones several, where they fit; at least one plane.
    pub fn new(dims_z: u64, unit_z: u64, units: u64, plane_bytes: u64, budget_bytes: u64) -> Self {
        let fit = (budget_bytes / plane_bytes.max(1)).clamp(1, dims_z.max(1));
        let unit_z = unit_z.min(dims_z);
        if fit < unit_z {
            return Self { planes: fit, period: unit_z };
        }
        let layers = (fit / unit_z).min(UNITS_AT_ONCE.div_ceil(units.max(1))).max(1);
        Self { planes: layers * unit_z, period: layers * unit_z }
    }

    /// The group that a plane is in.
    pub fn group(&self, z: u64, dims_z: u64) -> Range<u64> {
        let base = z / self.period * self.period;
        let start = base + (z - base) / self.planes * self.planes;
        start..(start + self.planes).min(base + self.period).min(dims_z)
    }
}

/// A group of decoded planes: x fastest, then y, then z.
pub(super) struct Planes {
    pub bytes: Vec<u8>,
    pub z: Range<u64>,
    pub dims_x: u64,
    pub dims_y: u64,
    pub voxel_bytes: usize,
}

impl Planes {
    /// Bytes of one plane.
    pub fn plane_bytes(&self) -> usize {
        (self.dims_x * self.dims_y) as usize * self.voxel_bytes
    }

    /// Makes room for the planes `z`, all voxels of one number.
    pub fn reset(&mut self, z: Range<u64>, number: &[u8]) {
        let voxels = (z.end - z.start) * self.dims_x * self.dims_y;
        self.z = z;
        self.bytes.clear();
        match number.iter().all(|byte| *byte == number[0]) {
            true => self.bytes.resize(voxels as usize * self.voxel_bytes, number[0]),
            false => self.bytes = number.repeat(voxels as usize),
        }
    }

    /// Copies what a block has of these planes; `picks` says which index of the other dimensions is meant.
    pub fn paste(&mut self, block: &Block, axes: &Axes, picks: &[u64]) {
        let strides = strides(&block.shape);
        let end = |axis: usize| block.start[axis] + block.shape[axis];
        let fixed = (0..axes.count).filter(|&axis| axis != axes.x && axis != axes.y && Some(axis) != axes.z);
        let origin: u64 = fixed.map(|axis| (picks[axis] - block.start[axis]) * strides[axis]).sum();
        let z_range = axes.z.map_or(0..1, |z| self.z.start.max(block.start[z])..self.z.end.min(end(z)));
        let y_range = block.start[axes.y]..end(axes.y).min(self.dims_y);
        let x_range = block.start[axes.x]..end(axes.x).min(self.dims_x);
        for z in z_range {
            let plane = origin + axes.z.map_or(0, |axis| (z - block.start[axis]) * strides[axis]);
            for y in y_range.clone() {
                let from = plane + (y - block.start[axes.y]) * strides[axes.y];
                let to = ((z - self.z.start) * self.dims_y + y) * self.dims_x + x_range.start;
                let row = (x_range.end - x_range.start) as usize;
                self.paste_row(&block.bytes, from as usize, strides[axes.x] as usize, to as usize, row);
            }
        }
    }

    fn paste_row(&mut self, from: &[u8], first: usize, stride: usize, to: usize, voxels: usize) {
        let bytes = self.voxel_bytes;
        let row = &mut self.bytes[to * bytes..(to + voxels) * bytes];
        if stride == 1 {
            row.copy_from_slice(&from[first * bytes..(first + voxels) * bytes]);
            return;
        }
        for (i, voxel) in row.chunks_exact_mut(bytes).enumerate() {
            let at = (first + i * stride) * bytes;
            voxel.copy_from_slice(&from[at..at + bytes]);
        }
    }
}

/// Voxels from one index of a dimension to the next, the last dimension fastest.
fn strides(shape: &[u64]) -> Vec<u64> {
    let mut strides = vec![1; shape.len()];
    for axis in (1..shape.len()).rev() {
        strides[axis - 1] = strides[axis] * shape[axis];
    }
    strides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_grouped_by_chunks_and_memory() {
        let whole = Grouping::new(100, 32, 16, 10, 10_000);
        assert_eq!(whole, Grouping { planes: 32, period: 32 });
        assert_eq!(whole.group(97, 100), 96..100);
        let several = Grouping::new(100, 1, 4, 10, 10_000);
        assert_eq!(several, Grouping { planes: 4, period: 4 });
        let part = Grouping::new(100, 32, 16, 10, 100);
        assert_eq!(part, Grouping { planes: 10, period: 32 });
        assert_eq!((part.group(31, 100), part.group(32, 100)), (30..32, 32..42));
        assert_eq!(Grouping::new(100, 32, 16, 10, 0).planes, 1);
    }

    #[test]
    fn every_plane_is_in_its_group() {
        for (unit, budget) in [(1, 7), (3, 7), (8, 5), (64, 1000), (7, 100)] {
            let grouping = Grouping::new(23, unit, 2, 1, budget);
            let mut next = 0;
            while next < 23 {
                let group = grouping.group(next, 23);
                assert!(group.start == next && group.end > next && group.end - group.start <= budget);
                assert!(group.clone().all(|z| grouping.group(z, 23) == group));
                next = group.end;
            }
        }
    }
}
