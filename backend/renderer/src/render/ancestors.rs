//! The bricks above a node, as filtering over levels reads them.

use super::brick_ranges::BrickRanges;
use bricks::{NodeKey, OVERLAP, OWN_EDGE};
use layout::{CELL_EDGE, CELLS_ACROSS};

/// Levels above a node that samples may be blended with.
pub(super) const MOST_ANCESTORS: usize = 2;

/// A brick above a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ancestor<'a> {
    ranges: BrickRanges<'a>,
    /// Levels between, 1 or 2.
    levels: u8,
    /// Where the node lies in it, in nodes of the node's own depth.
    offset: [usize; 3],
}

impl<'a> Ancestor<'a> {
    /// The brick of `above` for the node `key` below it.
    pub(super) fn new(key: NodeKey, above: NodeKey, ranges: BrickRanges<'a>) -> Self {
        let levels = key.depth - above.depth;
        let offset = (key.cell - (above.cell << glam::UVec3::splat(u32::from(levels)))).to_array();
        Self { ranges, levels, offset: offset.map(|c| c as usize) }
    }

    /// Smallest and largest data value around a cell of the node: of the cells of this brick that the cell reaches into,
    /// which are kept with a margin of two of this brick's texels.
    pub(super) fn values_around(&self, cell: [usize; 3], spreads: bool) -> [f64; 2] {
        let spans: [(usize, usize); 3] = std::array::from_fn(|axis| self.span(self.offset[axis], cell[axis]));
        let [xs, ys, zs] = spans.map(|(first, last)| first..=last);
        let rows = zs.flat_map(|z| ys.clone().map(move |y| (y, z)));
        let cells = rows.flat_map(|(y, z)| xs.clone().map(move |x| [x, y, z]));
        self.ranges.values_in(cells, spreads)
    }

    /// First and last cell of this brick along an axis that a cell of the node reaches into. A texel x of the node is
    /// voxel 28 offset + x − 2 of all nodes at its depth in this brick, and texel (28 offset + x − 2) / 2^levels + 2 here.
    fn span(&self, offset: usize, cell: usize) -> (usize, usize) {
        let texel = |x: usize| ((OWN_EDGE * offset + x).saturating_sub(OVERLAP) >> self.levels) + OVERLAP;
        let cell_of = |texel: usize| (texel / CELL_EDGE).min(CELLS_ACROSS - 1);
        (cell_of(texel(CELL_EDGE * cell)), cell_of(texel(CELL_EDGE * (cell + 1))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::working_set::ResidentBrick;
    use bricks::{BRICK_VOXELS, Brick, CellRanges};
    use glam::UVec3;

    #[test]
    fn a_cell_sees_the_samples_of_the_parent_that_lie_in_it() {
        // Parent samples that encode their own texel along x.
        let mut samples = vec![0u16; BRICK_VOXELS];
        for x in 0..32 {
            for (y, z) in (0..32).flat_map(|y| (0..32).map(move |z| (y, z))) {
                samples[Brick::index(x, y, z)] = x as u16;
            }
        }
        let ranges = CellRanges::of_samples(&samples);
        let brick = ResidentBrick { slot: 0, low: 0.0, span: 65535.0 };
        let ranges = BrickRanges { brick, samples: &ranges, deviations: None };
        for (levels, offset) in [(1, 0), (1, 1), (2, 0), (2, 3)] {
            let key = NodeKey { depth: 5, cell: UVec3::new(8 + offset, 4, 4) };
            let above =
                NodeKey { depth: 5 - levels, cell: UVec3::new(8 >> levels, 4 >> levels, 4 >> levels) };
            let ancestor = Ancestor::new(key, above, ranges);
            for cell in 0..8 {
                let [low, high] = ancestor.values_around([cell, 0, 0], true);
                for texel in 4 * cell..=4 * cell + 4 {
                    let own = (28 * offset as usize + texel) as f64 - 2.0;
                    let there = own / f64::from(1 << levels) + 2.0;
                    // Interpolation reaches half a texel beyond, a step another half; ends of the brick cut it off.
                    let reach = [(there - 1.5).max(0.0), (there + 0.5).min(31.0)];
                    assert!(
                        low <= reach[0].ceil() && high >= reach[1].floor(),
                        "{levels} {offset} {cell}: {low} to {high} for {reach:?}"
                    );
                }
            }
        }
    }
}
