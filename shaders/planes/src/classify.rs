//! What a slab's samples show between two depths, and whether means say enough of it.

use crate::fine::{Looked, mean_between};
use crate::lanes::*;
use crate::slab::{EMPTY, LANES, SOFT, STEEP, Slab};
use crate::steep::{Steep, range};
use twin::Casting;
use twin::composite::Over;
use twin::spread::sample_over;
use twin::tables::{Located, is_vacant_around, locate};

/// What classification goes by.
pub(crate) struct Classing<'a> {
    pub(crate) steep: Steep<'a>,
    /// Optical depth of a cell where the table says 1.
    pub(crate) thickness: f32,
    /// The largest error of a cell's light that means may have.
    pub(crate) tolerance: f32,
    /// Whether each view has to look for itself wherever anything shows.
    pub(crate) views_differ: bool,
}

/// The scalars of a block at two depths.
#[derive(Clone, Copy)]
struct Range {
    low: f32,
    high: f32,
    /// The largest difference of neighbours.
    apart: f32,
    spread: f32,
    /// The least of what they stand for.
    least_spread: f32,
}

impl Classing<'_> {
    /// What each block holds, by the range of its scalars.
    #[inline(always)]
    pub(crate) fn find_blocks(&self, slab: &mut Slab) {
        let across = slab.blocks_across();
        for cell in 0..slab.cells() {
            for block in 0..across {
                let Some(range) = range_of(slab, cell, block) else { continue };
                if is_vacant_around(&self.steep.casting.tables.cells, (range.low, range.high), range.spread) {
                    continue;
                }
                // A mean over a spread bends by less.
                let reach = ((range.low - range.spread).max(0.0), (range.high + range.spread).min(1.0));
                let share = if slab.spreads.is_empty() || range.apart >= 2.0 * range.least_spread {
                    1.0
                } else {
                    range.apart / (2.0 * range.least_spread)
                };
                let bend = share * self.steep.roughness.bend(reach.0, reach.1, range.apart);
                let class =
                    if self.views_differ || bend * self.thickness > self.tolerance { STEEP } else { SOFT };
                slab.blocks[cell * across + block] = class;
                slab.any[block] |= class;
            }
        }
    }

    /// Means, where they serve.
    #[inline(always)]
    pub(crate) fn find_means<S: Simd>(&self, simd: S, slab: &mut Slab) {
        let across = slab.blocks_across();
        for block in 0..across {
            for phase in 0..slab.phases {
                let mut known = None;
                for cell in 0..slab.cells() {
                    // Views that meet a block may meet its neighbours' means as well.
                    known = if slab.blocks[cell * across + block] == EMPTY {
                        None
                    } else {
                        self.means_of(simd, slab, (cell, block, phase), known)
                    };
                }
            }
        }
        self.find_unordered(slab);
    }

    /// Means of one block and phase. What the scalars at its back look up, if they were.
    #[inline(always)]
    fn means_of<S: Simd>(
        &self,
        simd: S,
        slab: &mut Slab,
        (cell, block, phase): (usize, usize, usize),
        looks: Option<Looked<S>>,
    ) -> Option<Looked<S>> {
        let row = slab.row_start(cell, phase) + block * LANES;
        let front = f32x8::from_slice(simd, &slab.scalars[row..row + LANES]);
        let back = slab.row_start(cell + 1, phase) + block * LANES;
        let behind = f32x8::from_slice(simd, &slab.scalars[back..back + LANES]);
        let (low, high) = range([front, behind])?;
        let mut spread = [0.0; LANES];
        if !slab.spreads.is_empty() {
            for (lane, spread) in spread.iter_mut().enumerate() {
                *spread = 0.5 * (slab.spreads[row + lane] + slab.spreads[back + lane]);
            }
        }
        let widest = largest(f32x8::load_array(simd, spread));
        if is_vacant_around(&self.steep.casting.tables.cells, (low, high), widest) {
            return None;
        }
        let thickness = f32x8::splat(simd, self.thickness);
        let out = 4 * slab.row_start(cell, phase) + block * LANES;
        let sum = front + behind;
        let is_met = sum.simd_eq(sum);
        let zero = f32x8::splat(simd, 0.0);
        let reach = ((low - widest).max(0.0), (high + widest).min(1.0));
        if !self.steep.is_fine(reach.0, reach.1, self.thickness) {
            let scalars = (front.to_array(), behind.to_array());
            let thickness = is_met.select(thickness, zero).to_array();
            for lane in 0..LANES {
                if thickness[lane] == 0.0 {
                    continue;
                }
                let (casting, ends) = (self.steep.casting, (scalars.0[lane], scalars.1[lane]));
                let (a, b) = (locate(casting.tables, ends.0), locate(casting.tables, ends.1));
                let k = mean(casting, [&a, &b], ends, spread[lane]);
                for (c, k) in k.into_iter().enumerate() {
                    slab.means[out + c * slab.stride + lane] = k * thickness[lane];
                }
            }
            return None;
        }
        let lowest = f32x8::splat(simd, low);
        let (front, behind) = (is_met.select(front, lowest), is_met.select(behind, lowest));
        let thickness = is_met.select(thickness, zero);
        if widest > 0.0 {
            let spread = f32x8::load_array(simd, spread);
            let k = self.steep.fine.mean_around(simd, [front, behind], spread);
            store(slab, out, k, thickness);
            return None;
        }
        let is_whole = is_met.all_true();
        let near = match looks {
            Some(looks) if is_whole => looks,
            Some(_) | None => self.steep.fine.look_up(simd, front),
        };
        let far = self.steep.fine.look_up(simd, behind);
        store(slab, out, mean_between(simd, &near, &far, behind - front), thickness);
        if is_whole { Some(far) } else { None }
    }

    /// Where the order of what a cell and the next show matters, means do not do.
    #[inline(always)]
    fn find_unordered(&self, slab: &mut Slab) {
        let (across, stride) = (slab.blocks_across(), slab.stride);
        for cell in 0..slab.cells().saturating_sub(1) {
            for block in 0..across {
                let both = [cell * across + block, (cell + 1) * across + block];
                if both.iter().any(|&at| slab.blocks[at] != SOFT) {
                    continue;
                }
                let mut worst = 0.0f32;
                for phase in 0..slab.phases {
                    let [a, b] = [cell, cell + 1].map(|cell| 4 * slab.row_start(cell, phase) + block * LANES);
                    for lane in 0..LANES {
                        let k = |start: usize, c: usize| slab.means[start + c * stride + lane];
                        let (ta, tb) = (k(a, 3), k(b, 3));
                        for c in 0..3 {
                            worst = worst.max((k(a, c) * tb - k(b, c) * ta).abs());
                        }
                    }
                }
                if worst > self.tolerance {
                    for at in both {
                        slab.blocks[at] |= STEEP;
                    }
                    slab.any[block] |= STEEP;
                }
            }
        }
    }
}

/// Keeps the means of eight columns.
#[inline(always)]
fn store<S: Simd>(slab: &mut Slab, out: usize, k: [f32x8<S>; 4], thickness: f32x8<S>) {
    for (c, k) in k.into_iter().enumerate() {
        let start = out + c * slab.stride;
        (k * thickness).store_slice(&mut slab.means[start..start + LANES]);
    }
}

/// Mean (τ c, τ) between two scalars.
#[inline(always)]
pub(crate) fn mean(
    casting: &Casting<f32>,
    located: [&Located<f32>; 2],
    scalars: (f32, f32),
    spread: f32,
) -> [f32; 4] {
    sample_over::<f32, Over<false>>(casting, located, scalars, spread).k
}

/// The scalars of a block and of the column after it. None if there are none.
#[inline(always)]
fn range_of(slab: &Slab, cell: usize, block: usize) -> Option<Range> {
    let mut range = Range { low: f32::MAX, high: f32::MIN, apart: 0.0, spread: 0.0, least_spread: f32::MAX };
    for depth in [cell, cell + 1] {
        for phase in 0..slab.phases {
            let start = slab.row_start(depth, phase) + block * LANES;
            let (next_phase, further) = if phase + 1 < slab.phases { (phase + 1, 0) } else { (0, 1) };
            let next = slab.row_start(depth, next_phase) + block * LANES + further;
            let is_last = block + 1 == slab.blocks_across();
            for lane in 0..LANES - usize::from(is_last) {
                let (s, t) = (slab.scalars[start + lane], slab.scalars[next + lane]);
                // A comparison with NaN is false.
                if s < range.low {
                    range.low = s;
                }
                if s > range.high {
                    range.high = s;
                }
                if t < range.low {
                    range.low = t;
                }
                if t > range.high {
                    range.high = t;
                }
                let apart = (s - t).abs();
                if apart > range.apart {
                    range.apart = apart;
                }
            }
            if !slab.spreads.is_empty() {
                for lane in 0..LANES {
                    if !slab.scalars[start + lane].is_nan() {
                        let spread = slab.spreads[start + lane];
                        range.spread = range.spread.max(spread);
                        range.least_spread = range.least_spread.min(spread);
                    }
                }
            }
        }
    }
    (range.low <= range.high).then_some(range)
}
