//! A brick: 32³ stored samples of one octree node.

use super::codes::{BRICK_EDGE, Codes};
use crate::CellRanges;

/// What the voxels of a coarse node stand for, beside their means: the standard deviation of the source's voxels in
/// each.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// [`super::BRICK_VOXELS`] codes, x fastest.
    pub codes: Vec<u8>,
    /// Data units per code: standard deviation = code × step.
    pub step: f32,
}

/// The voxels of one node. Sample (i, j, k), each in 0..32, of a node with own voxels starting at voxel (x, y, z)
/// of its level is the level's voxel (x + i − 2, y + j − 2, z + k − 2), clamped to the level's extent (edges repeat).
#[derive(Clone, Debug, PartialEq)]
pub struct Brick {
    /// The samples, quantised to the brick's own range.
    pub codes: Codes,
    /// Data value of code 0.
    pub low: f32,
    /// Data value per code: value = low + code × step.
    pub step: f32,
    /// Range of the codes around each cell, where the source keeps it.
    pub cells: Option<CellRanges>,
    /// Standard deviations, where the source keeps them; never at the finest level.
    pub deviation: Option<Deviation>,
}

impl Brick {
    /// A brick of which only the samples are known.
    pub fn new(codes: Codes, low: f32, step: f32) -> Self {
        Self { codes, low, step, cells: None, deviation: None }
    }

    /// Position of sample (i, j, k) in the codes.
    pub fn index(i: usize, j: usize, k: usize) -> usize {
        (k * BRICK_EDGE + j) * BRICK_EDGE + i
    }

    /// The data value at a stored index.
    pub fn value(&self, index: usize) -> f64 {
        f64::from(self.low) + f64::from(self.codes.at(index)) * f64::from(self.step)
    }
}
