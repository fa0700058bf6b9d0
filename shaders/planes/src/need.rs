//! How closely a slab has to be sampled, block by block: from what samples a voxel apart say.

use crate::blocks::Blocks;
use crate::fill::Grid;
use crate::rough::Variation;
use crate::slab::{LANES, Slab};
use glam::DVec3;
use lanes::*;
use twin::tables::is_vacant_around;

/// Distances between samples, each half the one before.
pub(crate) const SPACINGS: usize = 6;

/// Largest error of a cell's light that distances between samples make, in tolerances: it is found for the worst of a block, and
/// lies far above those of pictures; chosen from studies of both.
pub(crate) const SPACING_ERROR: f32 = 250.0;

/// What is left of an error at half the distance: between a quarter, where scalars bend evenly, and a half, at a kink.
const LEFT_AT_HALF: f32 = 0.35;

/// The least tolerance that samples a voxel apart serve, whatever is said of their errors, and gradients a quarter of a voxel apart.
const WIDEST_TOLERANCE: f32 = 1e-4;

/// How many times closer by half than these a tolerance asks for: what lies between two of them errs by the square of their distance.
pub(crate) fn halvings(tolerance: f32) -> usize {
    let halvings = (0.5 * (WIDEST_TOLERANCE / tolerance).log2()).ceil();
    (halvings.max(0.0) as usize).min(SPACINGS - 1)
}

/// The spacing at which so large an error of light at the widest one is within a tolerance of it.
pub(crate) fn spacing_for(error: f32, tolerance: f32) -> usize {
    let mut left = error;
    let mut spacing = 0;
    while left > tolerance && spacing + 1 < SPACINGS {
        left *= LEFT_AT_HALF;
        spacing += 1;
    }
    spacing
}

/// Samples that a row's plane has of a voxel, where those a voxel apart err by so much light, and at a scene's step tolerance.
pub fn samples_per_voxel(error: f32, tolerance: f32) -> u64 {
    let spacing = spacing_for(error.min(1.0), tolerance * SPACING_ERROR).max(halvings(tolerance));
    1 << (2 * spacing)
}

/// What the judgement goes by.
pub(crate) struct Judge<'a> {
    pub(crate) grid: &'a Grid<'a>,
    pub(crate) variation: &'a Variation,
    /// Optical depth from one sample to the next where the table says 1.
    pub(crate) thickness: f32,
    /// γ of importance accumulation; 0 where there is none.
    pub(crate) gamma: f32,
    /// The largest error of a cell's light.
    pub(crate) tolerance: f32,
}

impl Judge<'_> {
    /// The errors that distances between samples make in each cell of the `wanted` blocks, and which blocks show anything.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &self,
        simd: S,
        slab: &mut Slab,
        wanted: &Blocks,
        bends: &mut Vec<f32>,
        showing: &mut Blocks,
    ) {
        let across = slab.blocks_across();
        showing.clear(across);
        for block in wanted.iter() {
            let most_bend = find_bends(simd, slab, block, bends);
            let reach = [most_bend, most_spread(slab, block)];
            slab.reaches[block] = most_bend;
            let thickness = self.thickness * self.most_factor(slab, block);
            for cell in 0..slab.cells() {
                if let Some(error) = self.error_of(simd, slab, (cell, block), bends, reach, thickness) {
                    showing.insert(block);
                    slab.apart[cell * across + block] = error.min(1.0) / self.tolerance;
                }
            }
        }
    }

    /// The most that enhancers multiply an extinction by in a block and what its views meet beside it.
    fn most_factor(&self, slab: &Slab, block: usize) -> f32 {
        let Grid { fan, row, enhancers, .. } = *self.grid;
        if enhancers.is_empty() {
            return 1.0;
        }
        let [first, past] = [slab.columns(block)[0], slab.columns(block + 1)[1]];
        let corners: [DVec3; 8] = std::array::from_fn(|corner| {
            let depth = slab.ends()[corner >> 1 & 1];
            let column = if corner & 1 == 0 { first } else { past };
            let x = fan.x_of(column as f64 / slab.phases as f64, depth);
            DVec3::new(x, fan.y_at(row, depth), depth.z)
        });
        enhancers.iter().map(|enhancer| enhancer.most_factor(&corners)).product::<f64>() as f32
    }

    /// The largest error of light that scalars half-way between a cell's samples make. None if nothing shows.
    #[inline(always)]
    fn error_of<S: Simd>(
        &self,
        simd: S,
        slab: &Slab,
        (cell, block): (usize, usize),
        bends: &[f32],
        [most_bend, most_spread]: [f32; 2],
        thickness: f32,
    ) -> Option<f32> {
        let mut worst: Option<f32> = None;
        let tables = self.grid.casting.tables;
        let per = thickness / self.tolerance;
        for phase in 0..slab.phases {
            let [front, back] = [cell, cell + 1].map(|depth| (depth * slab.phases + phase) * LANES);
            let corners = [
                column(simd, slab, (cell, phase, block), 0),
                column(simd, slab, (cell, phase, block), 1),
                column(simd, slab, (cell + 1, phase, block), 0),
                column(simd, slab, (cell + 1, phase, block), 1),
            ];
            let mut low = splat(simd, f32::MAX);
            let mut high = splat(simd, f32::MIN);
            for corner in corners {
                low = corner.simd_lt(low).select(corner, low);
                high = corner.simd_gt(high).select(corner, high);
            }
            let (lowest, highest) = (least(low), greatest(simd, high));
            let (low, high) = (low.to_array(), high.to_array());
            let reach = most_bend + most_spread;
            if lowest > highest || is_vacant_around(&tables.cells, (lowest, highest), reach) {
                continue;
            }
            let mut found = worst.unwrap_or(0.0);
            let rise = self.gamma * self.variation.total_importance(lowest, highest, reach);
            if self.variation.total(lowest, highest, reach) * per <= 0.5 && rise <= 0.5 * self.tolerance {
                worst = Some(found);
                continue;
            }
            let twist = ((corners[3] - corners[2]) - (corners[1] - corners[0])).abs();
            let bent = load(simd, bends, front).max(load(simd, bends, back));
            let twist = twist.simd_eq(twist).select(twist, splat(simd, 0.0));
            let error = (splat(simd, 0.125) * (bent + twist)).to_array();
            for lane in 0..LANES {
                if low[lane] > high[lane] {
                    continue;
                }
                let spread = error[lane] + most_spread;
                if is_vacant_around(&tables.cells, (low[lane], high[lane]), spread) {
                    continue;
                }
                let change = self.variation.change(low[lane], high[lane], error[lane]);
                found = found.max(thickness * change);
                if self.gamma > 0.0 {
                    let rise = self.variation.change_of_importance(low[lane], high[lane], error[lane]);
                    found = found.max(self.gamma * rise);
                }
                worst = Some(found);
            }
        }
        worst
    }
}

/// Eight columns of a phase, and those `further` on.
#[inline(always)]
fn column<S: Simd>(
    simd: S,
    slab: &Slab,
    (depth, phase, block): (usize, usize, usize),
    further: usize,
) -> f32x8<S> {
    let (phase, entry) = slab.step(phase, further);
    load(simd, &slab.scalars, slab.row_start(depth, phase) + block * LANES + entry)
}

/// How far scalars of a block bend at each depth and phase, across and along, and the most of it; 0 where some are not known.
#[inline(always)]
fn find_bends<S: Simd>(simd: S, slab: &Slab, block: usize, bends: &mut Vec<f32>) -> f32 {
    let depths = slab.depths.len();
    bends.clear();
    bends.resize(depths * slab.phases * LANES, 0.0);
    let zero = splat(simd, 0.0);
    let mut most = zero;
    for depth in 0..depths {
        let middle = depth.min(depths - 2).max(1);
        for phase in 0..slab.phases {
            // Across: of the column after each, so that none of the block before is asked for.
            let at = (depth, phase, block);
            let ends = each!(further of 3 => column(simd, slab, at, further));
            let across = ((ends[0] - ends[1]) + (ends[2] - ends[1])).abs();
            let mut bend = across.simd_gt(zero).select(across, zero);
            if depths > 2 {
                let ends = each!(further of 3 => column(simd, slab, (middle - 1 + further, phase, block), 0));
                let along = ((ends[0] - ends[1]) + (ends[2] - ends[1])).abs();
                bend += along.simd_gt(zero).select(along, zero);
            }
            most = most.max(bend);
            let at = (depth * slab.phases + phase) * LANES;
            bend.store_slice(&mut bends[at..at + LANES]);
        }
    }
    largest(most)
}

/// The largest spread of a block's samples.
#[inline(always)]
fn most_spread(slab: &Slab, block: usize) -> f32 {
    let mut most = 0.0f32;
    if slab.spreads.is_empty() {
        return most;
    }
    for row in 0..slab.depths.len() * slab.phases {
        let start = row * slab.stride + block * LANES;
        for lane in start..start + LANES {
            if !slab.scalars[lane].is_nan() {
                most = most.max(slab.spreads[lane]);
            }
        }
    }
    most
}
