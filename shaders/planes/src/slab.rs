//! A slab of a row's plane: what all views share over some depths.

use crate::fan::AtDepth;

/// Pixels that are swept at once.
pub(crate) const LANES: usize = 8;

/// What a block of [`LANES`] columns between two depths holds.
pub(crate) const EMPTY: u8 = 0;
/// Means per column stand for what lies between them.
pub(crate) const SOFT: u8 = 1;
/// Each view looks at the scalars itself.
pub(crate) const STEEP: u8 = 2;

/// Samples at `depths.len()` depths of `phases` columns per pixel, and what lies between two depths.
///
/// Columns are kept phase by phase: column `phases · i + phase`, counted from `base`, is entry i of its phase's row. So what
/// neighbouring pixels of a view meet lies side by side.
#[derive(Debug, Default)]
pub struct Slab {
    pub(crate) depths: Vec<AtDepth>,
    /// Half-way between each depth and the next.
    pub(crate) middles: Vec<AtDepth>,
    /// Columns per pixel.
    pub(crate) phases: usize,
    /// The pixel column of entry 0.
    pub(crate) base: i64,
    /// Entries of a phase's row, a multiple of [`LANES`].
    pub(crate) stride: usize,
    /// Depth by depth, phase by phase; NaN where nothing shows.
    pub(crate) scalars: Vec<f32>,
    /// Half-width of the scalars that each stands for, likewise; empty where each stands for itself.
    pub(crate) spreads: Vec<f32>,
    /// Gradients, three rows per depth and phase; empty where no light falls.
    pub(crate) gradients: Vec<f32>,
    /// Between depths: optical depth times colour, and optical depth, of a ray along z; four rows per cell and phase.
    pub(crate) means: Vec<f32>,
    /// Cell by cell, what each block of columns holds.
    pub(crate) blocks: Vec<u8>,
    /// Of each block, all of them over the slab.
    pub(crate) any: Vec<u8>,
    /// Whether part of it lies outside the volume.
    pub(crate) is_outer: bool,
}

/// What a slab keeps besides scalars.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keeps {
    pub(crate) spreads: bool,
    pub(crate) gradients: bool,
}

fn fill(list: &mut Vec<f32>, len: usize, value: f32) {
    list.clear();
    list.resize(len, value);
}

impl Slab {
    /// Depths that a ray along z goes through, less one.
    pub(crate) fn cells(&self) -> usize {
        self.middles.len()
    }

    pub(crate) fn blocks_across(&self) -> usize {
        self.stride / LANES
    }

    /// Makes room for the columns from pixel `first` to `last`, of which nothing is known.
    pub(crate) fn clear(&mut self, first: i64, last: i64, keeps: Keeps) {
        let lanes = LANES as i64;
        self.base = first.div_euclid(lanes) * lanes - lanes;
        let past = (last + 1 + lanes).div_euclid(lanes) * lanes + 2 * lanes;
        self.stride = (past - self.base) as usize;
        let row = self.phases * self.stride;
        let (depths, cells) = (self.depths.len(), self.cells());
        fill(&mut self.scalars, depths * row, f32::NAN);
        fill(&mut self.spreads, if keeps.spreads { depths * row } else { 0 }, 0.0);
        fill(&mut self.gradients, if keeps.gradients { 3 * depths * row } else { 0 }, 0.0);
        fill(&mut self.means, 4 * cells * row, 0.0);
        self.blocks.clear();
        self.blocks.resize(cells * self.blocks_across(), EMPTY);
        self.any.clear();
        self.any.resize(self.blocks_across(), EMPTY);
    }

    /// Phase and entry of a column.
    #[inline(always)]
    pub(crate) fn place(&self, column: i64) -> (usize, usize) {
        let phases = self.phases as i64;
        (column.rem_euclid(phases) as usize, (column.div_euclid(phases) - self.base) as usize)
    }

    /// Where the row of a phase at a depth begins, in lists of one row for each.
    #[inline(always)]
    pub(crate) fn row_start(&self, depth: usize, phase: usize) -> usize {
        (depth * self.phases + phase) * self.stride
    }
}
