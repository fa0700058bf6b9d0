//! A slab of a row's plane: what all views share over some depths.

use crate::Fan;
use crate::blocks::Blocks;
use crate::fan::AtDepth;
use lanes::*;

/// Pixels that are swept at once.
pub(crate) const LANES: usize = 8;

/// Columns of the next block that are known with a block.
pub(crate) const HALO: usize = 2;

/// The error of a block's means between two depths where nothing shows.
pub(crate) const EMPTY: f32 = -1.0;

/// What views meet of a block and the next between two depths: nothing, means that say enough, or more than these say.
pub(crate) const NOTHING: u8 = 0;
pub(crate) const MEANS: u8 = 1;
const MORE: u8 = 3;

/// Rows of a cell's means and phase: without light, and with.
pub(crate) const PLAIN_ROWS: usize = 4;
pub(crate) const LIT_ROWS: usize = 7;

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
    /// Where each column of the first block, and of those known with a block, is kept.
    offsets: Vec<usize>,
    /// Depth by depth, phase by phase; NaN where nothing shows.
    pub(crate) scalars: Vec<f32>,
    /// Half-width of the scalars that each stands for, likewise; empty where each stands for itself.
    pub(crate) spreads: Vec<f32>,
    /// Gradients, three rows per level, depth and phase; empty where nothing asks for any.
    pub(crate) gradients: Vec<f32>,
    /// Between depths, where anything shows: optical depth times colour, lit but for the highlight, and optical depth, of a ray
    /// along z; where light falls the gradient as well.
    pub(crate) means: Vec<f32>,
    /// Rows of gradients per depth and phase: three for each level that is asked for.
    pub(crate) gradient_rows: usize,
    /// Rows of means per cell and phase.
    pub(crate) mean_rows: usize,
    /// Cell by cell, the largest error of light that each block's means make; [`EMPTY`] where nothing shows.
    pub(crate) errors: Vec<f32>,
    /// Likewise, whether those between columns are known to be small.
    pub(crate) is_sure: Vec<bool>,
    /// Likewise, the error of light that distances between samples make, as a share of what it may be.
    pub(crate) apart: Vec<f32>,
    /// Likewise, what views meet of a block and the next.
    pub(crate) kinds: Vec<u8>,
    /// Block by block, more than what scalars between samples are off by.
    pub(crate) reaches: Vec<f32>,
    /// Blocks that show anything.
    pub(crate) shown: Blocks,
    /// Whether part of it lies outside the volume.
    pub(crate) is_outer: bool,
}

/// What a slab keeps besides scalars.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keeps {
    pub(crate) spreads: bool,
    /// Levels of gradients: none, the sample's own, or all three.
    pub(crate) gradient_levels: usize,
    /// How many times closer by half than at the default gradients are taken, and samples lie.
    pub(crate) halvings: usize,
    /// Means of what lies between depths.
    pub(crate) means: bool,
}

/// Gives a list room for `len` numbers, whatever they are.
fn reserve(list: &mut Vec<f32>, len: usize) {
    if list.len() < len {
        list.resize(len, 0.0);
    }
}

impl Slab {
    /// Depths that a ray along z goes through, less one.
    pub(crate) fn cells(&self) -> usize {
        self.middles.len()
    }

    pub(crate) fn blocks_across(&self) -> usize {
        self.stride / LANES
    }

    /// Its first depth and its last.
    pub(crate) fn ends(&self) -> [&AtDepth; 2] {
        [&self.depths[0], &self.depths[self.depths.len() - 1]]
    }

    /// Lays rows out for the columns from one pixel to another.
    pub(crate) fn lay_columns(&mut self, [first, last]: [i64; 2]) {
        let lanes = LANES as i64;
        self.base = first.div_euclid(lanes) * lanes - 2 * lanes;
        let past = (last + 1 + lanes).div_euclid(lanes) * lanes + 3 * lanes;
        self.stride = (past - self.base) as usize;
    }

    /// Makes room for samples of the blocks that are `wanted`, of which nothing is known.
    pub(crate) fn clear(&mut self, wanted: &Blocks, keeps: Keeps) {
        let (rows, cells) = (self.depths.len() * self.phases, self.cells());
        let of = |keeps: bool, len: usize| if keeps { len } else { 0 };
        reserve(&mut self.scalars, rows * self.stride);
        self.gradient_rows = 3 * keeps.gradient_levels;
        self.mean_rows = if keeps.gradient_levels > 0 { LIT_ROWS } else { PLAIN_ROWS };
        let means = of(keeps.means, self.mean_rows * cells * self.phases * self.stride);
        reserve(&mut self.means, means);
        for (list, len) in [
            (&mut self.spreads, of(keeps.spreads, rows * self.stride)),
            (&mut self.gradients, self.gradient_rows * rows * self.stride),
        ] {
            list.truncate(len);
            reserve(list, len);
        }
        let columns = self.phases * LANES + HALO;
        self.offsets.clear();
        self.offsets.extend((0..columns).map(|i| i % self.phases * self.stride + i / self.phases));
        let across = self.blocks_across();
        for block in wanted.iter() {
            // A little of the next block is sampled, too.
            let entries = block * LANES..(block + 2).min(across) * LANES;
            for start in (0..rows).map(|row| row * self.stride) {
                let at = start + entries.start..start + entries.end;
                self.scalars[at.clone()].fill(f32::NAN);
                if keeps.spreads {
                    self.spreads[at].fill(0.0);
                }
            }
            for start in (0..self.gradient_rows * rows).map(|row| row * self.stride) {
                self.gradients[start + entries.start..start + entries.end].fill(0.0);
            }
        }
        self.errors.clear();
        self.errors.resize(cells * across, EMPTY);
        self.is_sure.clear();
        self.is_sure.resize(cells * across, false);
        self.apart.clear();
        self.apart.resize(cells * across, 0.0);
        self.reaches.clear();
        self.reaches.resize(across, 0.0);
        self.shown.clear(across);
    }

    /// Finds what views meet, where means may err by a `tolerance`; `is_alone`: where rays sample for themselves what is too far
    /// apart.
    pub(crate) fn find_kinds(&mut self, tolerance: f32, is_alone: bool) {
        let kind_of = |(&error, &apart): (&f32, &f32)| match error {
            EMPTY => NOTHING,
            _ if error > tolerance || is_alone && apart > 1.0 => MORE,
            _ => MEANS,
        };
        self.kinds.clear();
        self.kinds.extend(self.errors.iter().zip(&self.apart).map(kind_of));
        for at in 1..self.kinds.len() {
            self.kinds[at - 1] |= self.kinds[at];
        }
    }

    /// The blocks that the first block of a view's pixels meets, counted from the slab's first: the least and the most. Its
    /// other blocks meet as many more.
    pub(crate) fn reach(&self, fan: &Fan, view: usize) -> [i64; 2] {
        let [a, b] = self.ends().map(|depth| (0.5 + fan.shift(view, depth)).floor() as i64 - self.base);
        let lanes = LANES as i64;
        [(a.min(b) - 1).div_euclid(lanes), (a.max(b) + 1 + lanes).div_euclid(lanes)]
    }

    /// Its columns, but for the first block and the last, which no view meets: the first, and one past the last.
    pub(crate) fn inner_columns(&self) -> [i64; 2] {
        [1, self.blocks_across() - 1].map(|block| self.columns(block)[0])
    }

    /// The columns of a block: the first, and one past the last.
    #[inline(always)]
    pub(crate) fn columns(&self, block: usize) -> [i64; 2] {
        [block, block + 1].map(|block| (self.base + (block * LANES) as i64) * self.phases as i64)
    }

    /// Whether a block, or the one before it, shows anything between two depths: views that meet one meet both.
    #[inline(always)]
    pub(crate) fn shows(&self, block: usize, [from, to]: [usize; 2]) -> bool {
        for cell in from..to {
            let at = cell * self.blocks_across() + block;
            if self.errors[at] != EMPTY || self.errors[at.saturating_sub(1)] != EMPTY {
                return true;
            }
        }
        false
    }

    /// The block that a column lies in.
    pub(crate) fn block_of(&self, column: i64) -> usize {
        (column.div_euclid(self.phases as i64) - self.base) as usize / LANES
    }

    /// Where a block's column is kept, its `index`th, in lists of one row for each depth and phase.
    #[inline(always)]
    pub(crate) fn place(&self, depth: usize, block: usize, index: usize) -> usize {
        self.row_start(depth, 0) + block * LANES + self.offsets[index]
    }

    /// The phase of the columns `further` on from those of a phase, and by how many entries they are further.
    #[inline(always)]
    pub(crate) fn step(&self, phase: usize, further: usize) -> (usize, usize) {
        ((phase + further) % self.phases, (phase + further) / self.phases)
    }

    /// Where the rows of means of a phase and cell begin.
    #[inline(always)]
    pub(crate) fn mean_start(&self, cell: usize, phase: usize) -> usize {
        self.mean_rows * self.row_start(cell, phase)
    }

    /// Where the rows of a level's gradients begin.
    #[inline(always)]
    pub(crate) fn gradient_start(&self, depth: usize, phase: usize, level: usize) -> usize {
        self.gradient_rows * self.row_start(depth, phase) + 3 * level * self.stride
    }

    /// Where the row of a phase at a depth begins, in lists of one row for each.
    #[inline(always)]
    pub(crate) fn row_start(&self, depth: usize, phase: usize) -> usize {
        (depth * self.phases + phase) * self.stride
    }
}

/// What lies between two columns, for eight pixels: `part` of the way from what is kept at one place to what is at another.
#[inline(always)]
pub(crate) fn between<S: Simd>(simd: S, list: &[f32], starts: [usize; 2], part: f32x8<S>) -> f32x8<S> {
    let (a, b) = (load(simd, list, starts[0]), load(simd, list, starts[1]));
    a + (b - a) * part
}
