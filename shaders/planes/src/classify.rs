//! What a slab's samples show between two depths, and whether means say enough of it.

use crate::around::Around;
use crate::blocks::Blocks;
use crate::rough::Variation;
use crate::slab::{EMPTY, LANES, Slab};
use crate::steep::Steep;
use lanes::*;
use twin::Casting;
use twin::composite::Over;
use twin::spread::sample_over;
use twin::tables::{Located, locate};

/// What classification goes by.
pub(crate) struct Classing<'a> {
    pub(crate) steep: Steep<'a>,
    pub(crate) variation: &'a Variation,
    /// Optical depth of a cell where the table says 1.
    pub(crate) thickness: f32,
    /// The largest error of a cell's light that means may have.
    pub(crate) tolerance: f32,
}

/// Where this share of the tolerance bounds what means err, nothing else is asked.
const SURE: f32 = 0.25;

/// The scalars of a block at two depths.
#[derive(Clone, Copy)]
struct Range {
    around: Around,
    /// The largest difference of neighbours.
    apart: f32,
    /// The least of what they stand for.
    least_spread: f32,
}

impl Classing<'_> {
    /// What each block holds, by the range of its scalars.
    #[inline(always)]
    pub(crate) fn find_blocks<S: Simd>(&self, simd: S, slab: &mut Slab, wanted: &Blocks) {
        let across = slab.blocks_across();
        for block in wanted.iter() {
            for cell in 0..slab.cells() {
                let at = cell * across + block;
                // Something may show between samples that show nothing.
                if slab.apart[at] > 1.0 {
                    slab.errors[at] = 0.0;
                    slab.shown.insert(block);
                }
                let Some(range) = range_of(simd, slab, cell, block) else { continue };
                if self.steep.is_vacant(&range.around) {
                    continue;
                }
                // A mean over a spread bends by less.
                let reach = range.around.reach();
                let share = if slab.spreads.is_empty() || range.apart >= 2.0 * range.least_spread {
                    1.0
                } else {
                    range.apart / (2.0 * range.least_spread)
                };
                let bend = share * self.steep.roughness.bend(reach.0, reach.1, range.apart);
                let is_sure = bend * self.thickness <= SURE * self.tolerance;
                slab.errors[at] = 0.0;
                slab.is_sure[at] = is_sure;
                slab.shown.insert(block);
            }
        }
    }

    /// Finds means of all that shows and the error that each makes: how far it is from straight between columns, what it hides
    /// there, and how much the order of what a cell and the next show matters.
    #[inline(always)]
    pub(crate) fn settle<S: Simd>(&self, simd: S, slab: &mut Slab, wanted: &Blocks) {
        let across = slab.blocks_across();
        self.find_means(simd, slab, wanted);
        for block in wanted.iter() {
            for cell in 0..slab.cells() {
                let at = cell * across + block;
                if slab.errors[at] != EMPTY && !slab.is_sure[at] {
                    let after = self.mean_after(simd, slab, cell, block);
                    let bent = 0.125 * bent(simd, slab, (cell, block), after);
                    slab.errors[at] = slab.errors[at].max(bent).max(self.hidden(simd, slab, cell, block));
                }
            }
            for cell in 0..slab.cells().saturating_sub(1) {
                let both = [cell * across + block, (cell + 1) * across + block];
                if slab.errors[both[0]] != EMPTY && slab.errors[both[1]] != EMPTY {
                    let disorder = disorder_of_both(simd, slab, cell, block);
                    for at in both {
                        slab.errors[at] = slab.errors[at].max(disorder);
                    }
                }
            }
        }
    }

    /// The largest optical depth that lies between two columns of a block and shows at neither.
    #[inline(always)]
    fn hidden<S: Simd>(&self, simd: S, slab: &Slab, cell: usize, block: usize) -> f32 {
        let mut most = 0.0f32;
        for phase in 0..slab.phases {
            let (next_phase, entry) = slab.step(phase, 1);
            let here = slab.row_start(cell, phase) + block * LANES;
            let next = slab.row_start(cell, next_phase) + block * LANES + entry;
            let depth = slab.phases * slab.stride;
            let (a, b) = (load(simd, &slab.scalars, here), load(simd, &slab.scalars, here + depth));
            let (c, d) = (load(simd, &slab.scalars, next), load(simd, &slab.scalars, next + depth));
            let low = a.max(b).min(c.max(d));
            let high = a.min(b).max(c.min(d));
            let sum = a + b + c + d;
            let is_met = sum.simd_eq(sum);
            if !(high.simd_gt(low) & is_met).any_true() {
                continue;
            }
            let (low, high) = (is_met.select(low, high).to_array(), high.to_array());
            for lane in 0..LANES {
                let spread = if slab.spreads.is_empty() { 0.0 } else { slab.spreads[here + lane] };
                if high[lane] - low[lane] > 2.0 * spread {
                    most = most.max(self.variation.hidden(low[lane] + spread, high[lane] - spread));
                }
            }
        }
        most * self.thickness
    }
}

/// The largest second difference of a cell's means across the columns of a block and the one `after` it.
#[inline(always)]
fn bent<S: Simd>(simd: S, slab: &Slab, (cell, block): (usize, usize), after: [f32; 4]) -> f32 {
    let mut most = splat(simd, 0.0);
    let two = splat(simd, 2.0);
    let (phases, means) = (slab.phases, &slab.means);
    for phase in 0..phases {
        // The column before each and the one after. The first of all is compared with no other block.
        let (before, entry) = if phase == 0 { (phases - 1, 0) } else { (phase - 1, 1) };
        let (after_phase, further) = slab.step(phase, 1);
        let starts = [
            slab.mean_start(cell, before) + block * LANES + entry - 1,
            slab.mean_start(cell, phase) + block * LANES,
            slab.mean_start(cell, after_phase) + block * LANES + further,
        ];
        let mut here = splat(simd, 0.0);
        for (c, after) in after.into_iter().enumerate() {
            let mut ends = each!(i of 3 => load(simd, means, starts[i] + c * slab.stride));
            if phase + 1 == phases {
                let mut lanes = ends[2].to_array();
                lanes[LANES - 1] = after;
                ends[2] = f32x8::load_array(simd, lanes);
            }
            here = here.max((ends[0] + ends[2] - two * ends[1]).abs());
        }
        if phase == 0 {
            let mut lanes = here.to_array();
            lanes[0] = 0.0;
            here = f32x8::load_array(simd, lanes);
        }
        most = most.max(here);
    }
    largest(most)
}

/// How much the order of what a cell and the next show matters, at most.
#[inline(always)]
fn disorder_of_both<S: Simd>(simd: S, slab: &Slab, cell: usize, block: usize) -> f32 {
    let mut most = splat(simd, 0.0);
    let means = &slab.means;
    for phase in 0..slab.phases {
        let [a, b] = [cell, cell + 1].map(|cell| slab.mean_start(cell, phase) + block * LANES);
        let opacity = 3 * slab.stride;
        let (ta, tb) = (load(simd, means, a + opacity), load(simd, means, b + opacity));
        for c in 0..3 {
            let colour = c * slab.stride;
            let (ka, kb) = (load(simd, means, a + colour), load(simd, means, b + colour));
            most = most.max((ka * tb - kb * ta).abs());
        }
    }
    largest(most)
}

/// Mean (τ c, τ) between two scalars that nobody has looked up.
#[inline(always)]
pub(crate) fn mean_alone(casting: &Casting<f32>, scalars: (f32, f32), spread: f32) -> [f32; 4] {
    let (a, b) = (locate(casting.tables, scalars.0), locate(casting.tables, scalars.1));
    mean(casting, [&a, &b], scalars, spread)
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
fn range_of<S: Simd>(simd: S, slab: &Slab, cell: usize, block: usize) -> Option<Range> {
    let zero = splat(simd, 0.0);
    let (mut low, mut high) = (splat(simd, f32::MAX), splat(simd, f32::MIN));
    let mut apart = zero;
    let (mut spread, mut least_spread) = (zero, splat(simd, f32::MAX));
    for depth in [cell, cell + 1] {
        for phase in 0..slab.phases {
            let (next_phase, further) = slab.step(phase, 1);
            let start = slab.row_start(depth, phase) + block * LANES;
            let here = load(simd, &slab.scalars, start);
            let next = load(simd, &slab.scalars, slab.row_start(depth, next_phase) + block * LANES + further);
            // A comparison with NaN is false.
            low = here.simd_lt(low).select(here, low);
            high = here.simd_gt(high).select(here, high);
            let between = (here - next).abs();
            let are_known = between.simd_ge(zero);
            low = (are_known & next.simd_lt(low)).select(next, low);
            high = (are_known & next.simd_gt(high)).select(next, high);
            apart = between.simd_gt(apart).select(between, apart);
            if !slab.spreads.is_empty() {
                let is_known = here.simd_eq(here);
                let around = load(simd, &slab.spreads, start);
                spread = is_known.select(spread.max(around), spread);
                least_spread = is_known.select(least_spread.min(around), least_spread);
            }
        }
    }
    let (low, high) = (least(low), greatest(simd, high));
    (low <= high).then_some(Range {
        around: Around { low, high, spread: largest(spread) },
        apart: largest(apart),
        least_spread: least(least_spread),
    })
}
