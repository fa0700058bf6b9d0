//! The grid of a scene as kernels on a GPU sample it, rows of tiles at a time.

use crate::Fan;
use crate::leaves::{Leaf, extent, leaves, volume_from_display};
use crate::need::{SPACING_ERROR, halvings};
use crate::parts::{Part, parts, phases_of};
use crate::rough::Variation;
use crate::row::MEAN_ERROR;
use glam::{DAffine3, DVec3};
use layout::{FanBlock, NodeRecord, PlaneLayer, PlaneVariation, TILE_EDGE};
use needs::tables::Tables;
use optics::Enhancer;
use std::ops::Range;
use twin::{Lattice, SceneNumbers};

/// A scene's planes for the views of a fan: where samples lie. How far they are apart follows from the voxels there and from the
/// tolerance; what is too steep for that goes ray by ray.
pub struct Plan<'a> {
    fan: &'a Fan,
    leaves: Vec<Leaf>,
    enhancers: &'a [Enhancer],
    volume_from_display: DAffine3,
    /// How many times closer by half than a voxel samples are.
    halvings: usize,
    tolerance: f32,
}

impl<'a> Plan<'a> {
    /// For a scene with some enhancers whose index has these nodes.
    pub fn new(
        scene: &SceneNumbers<f32>,
        nodes: &[NodeRecord],
        fan: &'a Fan,
        enhancers: &'a [Enhancer],
    ) -> Self {
        Self {
            fan,
            enhancers,
            leaves: leaves(scene, nodes, fan),
            volume_from_display: volume_from_display(scene),
            halvings: halvings(scene.tolerance),
            tolerance: scene.tolerance,
        }
    }

    /// How much the transfer functions vary, border by border of the tables' cells.
    pub fn variation(tables: &Tables) -> Vec<PlaneVariation> {
        Variation::of(tables).entries()
    }

    /// What its kernels are told of the grid, before any row is swept.
    pub fn block(&self, lattice: &Lattice) -> FanBlock {
        let [width, rows] = self.fan.raster;
        FanBlock {
            most_spacing_error: SPACING_ERROR * self.tolerance,
            most_mean_error: MEAN_ERROR * self.tolerance,
            blocks: width.div_ceil(TILE_EDGE),
            step: lattice.step[1],
            first_row: lattice.first[1],
            rows,
            ..self.fan.block()
        }
    }

    /// The layers of some rows, slab by slab from the front to the back; where they are kept is still to be said.
    pub fn layers(&self, rows: &Range<u32>) -> Vec<Vec<PlaneLayer>> {
        let meets = |leaf: &&Leaf| leaf.rows[0] < rows.end && rows.start < leaf.rows[1];
        let leaves: Vec<Leaf> = self.leaves.iter().filter(meets).copied().collect();
        let speed = |row: u32| {
            (self.volume_from_display.matrix3 * DVec3::new(0.0, self.fan.y_slope(row), 1.0)).length()
        };
        let fastest = speed(rows.start).max(speed(rows.end.saturating_sub(1)));
        let slab = |part| self.slab(&leaves, part);
        parts(&leaves, fastest).filter_map(slab).collect()
    }

    /// The most that enhancers multiply an extinction by in some rows, block by block of a layer's slab.
    pub fn factors(&self, rows: &Range<u32>, layer: &PlaneLayer) -> Vec<f32> {
        let ends = layer.slab_z.map(|z| self.fan.at(f64::from(z)));
        let ends_of_rows = [rows.start, rows.end.saturating_sub(1)];
        let first = layer.first / layer.phases as i32;
        let factor = |block: u32| {
            let low = first + (block * TILE_EDGE) as i32;
            // What a cell of the last column lies in ends at the block beyond.
            let columns = [low, low + 2 * TILE_EDGE as i32];
            let corners: [DVec3; 8] = std::array::from_fn(|corner| {
                let pick = |bit: usize| corner >> bit & 1;
                let depth = &ends[pick(2)];
                let x = self.fan.x_of(f64::from(columns[pick(0)]), depth);
                DVec3::new(x, self.fan.y_at(ends_of_rows[pick(1)], depth), depth.z)
            });
            self.enhancers.iter().map(|enhancer| enhancer.most_factor(&corners)).product::<f64>() as f32
        };
        (0..layer.blocks()).map(factor).collect()
    }

    fn slab(&self, leaves: &[Leaf], Part { z: [from, to], edge, cells }: Part) -> Option<Vec<PlaneLayer>> {
        let cells = cells << self.halvings;
        let ends = [self.fan.at(from), self.fan.at(to)];
        let near: Vec<Leaf> =
            leaves.iter().filter(|leaf| leaf.z[0] > to && leaf.z[1] < from).copied().collect();
        let [first, last] = extent(self.fan, &near, [&ends[0], &ends[1]]);
        let block = i64::from(TILE_EDGE);
        let columns = [first.div_euclid(block) * block, (last + block).div_euclid(block) * block];
        let per_metre = self.volume_from_display.matrix3.x_axis.length();
        let phases = phases_of(ends.map(|at| self.fan.pitch(&at) * per_metre), edge, self.halvings);
        let depth = |k: usize| (from + (to - from) * (k as f64 / cells as f64)) as f32;
        let layer = |k: usize| PlaneLayer {
            z: [depth(k), depth((k + 1).min(cells))],
            slab_z: [from as f32, to as f32],
            phases: phases as f32,
            first: (columns[0] * phases as i64) as i32,
            width: ((columns[1] - columns[0]) * phases as i64) as u32,
            at: 0,
            block_at: 0,
            has_cell: u32::from(k < cells),
            has_cell_before: u32::from(k > 0),
            padding: 0,
        };
        (first < last).then(|| (0..=cells).map(layer).collect())
    }
}
