//! The voxels of a part of a level, put together from bricks.

use super::ExportError;
use super::rounding::Rounding;
use super::supply::Supply;
use bricks::volume::Samples;
use bricks::{Brick, NodeKey, OVERLAP, OWN_EDGE};
use glam::UVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Bricks that are unpacked before they are put into the planes: some megabytes.
const BRICKS_AT_ONCE: usize = 128;

/// A box of voxels of one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub depth: u8,
    /// First voxel.
    pub low: UVec3,
    /// Voxels along each axis.
    pub size: UVec3,
}

impl Part {
    /// A box of the part, in voxels from its own first one, as a part.
    pub fn section(self, low: UVec3, size: UVec3) -> Self {
        Self { low: self.low + low, size, ..self }
    }

    /// The planes `z` of the part, which count from its own first one, as a part.
    pub fn planes(self, z: Range<u32>) -> Self {
        self.section(UVec3::new(0, 0, z.start), UVec3::new(self.size.x, self.size.y, z.end - z.start))
    }

    /// The planes in groups of so many at most, which end where bricks do.
    pub fn layers(self, most_planes: u32) -> impl Iterator<Item = Range<u32>> {
        let own = OWN_EDGE as u32;
        let (first, end) = (self.low.z, self.low.z + self.size.z);
        let layers = first / own..end.div_ceil(own);
        let layers = layers.map(move |layer| (layer * own).max(first)..((layer + 1) * own).min(end));
        layers.flat_map(move |layer| {
            let groups = layer.clone().step_by(most_planes as usize);
            groups.map(move |start| start - first..(start + most_planes).min(layer.end) - first)
        })
    }

    pub fn voxels(self) -> usize {
        self.size.to_array().into_iter().map(|n| n as usize).product()
    }

    /// The nodes that hold something of it.
    fn nodes(self) -> impl Iterator<Item = NodeKey> {
        let own = UVec3::splat(OWN_EDGE as u32);
        let (low, end) = (self.low / own, (self.low + self.size + own - 1) / own);
        let node = move |x, y, z| NodeKey { depth: self.depth, cell: UVec3::new(x, y, z) };
        let row = move |y, z| (low.x..end.x).map(move |x| node(x, y, z));
        (low.z..end.z).flat_map(move |z| (low.y..end.y).flat_map(move |y| row(y, z)))
    }

    /// Reads the bricks of the part, some at a time, and hands them over in order; false from `take` ends it.
    pub fn bricks(
        self,
        supply: Supply,
        mut take: impl FnMut(NodeKey, &Brick) -> Result<bool, ExportError>,
    ) -> Result<(), ExportError> {
        let mut rest = self.nodes();
        loop {
            supply.check_stop()?;
            let nodes: Vec<_> = rest.by_ref().take(BRICKS_AT_ONCE).collect();
            if nodes.is_empty() {
                return Ok(());
            }
            let bricks: Result<Vec<_>, _> = nodes.par_iter().map(|&node| supply.source.brick(node)).collect();
            for (&node, brick) in nodes.iter().zip(&bricks?) {
                if !take(node, brick)? {
                    return Ok(());
                }
            }
        }
    }

    /// Rows along x that a node shares with the part: the stored index of the first voxel in the brick, its place in
    /// the part (x fastest), and how many there are.
    pub fn rows(self, node: NodeKey) -> impl Iterator<Item = (usize, usize, usize)> {
        let own = node.cell * OWN_EDGE as u32;
        let low = own.max(self.low);
        let end = (own + OWN_EDGE as u32).min(self.low + self.size);
        let row = move |y: u32, z: u32| {
            let in_brick = (UVec3::new(low.x, y, z) - own).to_array().map(|n| n as usize + OVERLAP);
            let [x, y, z] = (UVec3::new(low.x, y, z) - self.low).to_array().map(|n| n as usize);
            let place = (z * self.size.y as usize + y) * self.size.x as usize + x;
            (Brick::index(in_brick[0], in_brick[1], in_brick[2]), place, (end.x - low.x) as usize)
        };
        (low.z..end.z).flat_map(move |z| (low.y..end.y).map(move |y| row(y, z)))
    }

    /// All voxels of it, x fastest.
    pub fn samples(self, supply: Supply, rounding: Rounding) -> Result<Samples, ExportError> {
        let mut samples = Samples::new(rounding.element, self.voxels());
        self.bricks(supply, |node, brick| {
            for (index, place, voxels) in self.rows(node) {
                for i in 0..voxels {
                    samples.set(place + i, rounding.round(brick.value(index + i))?);
                }
            }
            Ok(true)
        })?;
        Ok(samples)
    }
}
