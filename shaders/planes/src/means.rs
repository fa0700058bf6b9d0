//! Means of what lies between two depths, column by column: all views share them.

use crate::around::Around;
use crate::blocks::Blocks;
use crate::classify::{Classing, mean_alone};
use crate::fine::{Looked, mean_between};
use crate::places::Places;
use crate::slab::{EMPTY, LANES, PLAIN_ROWS, Slab, between};
use crate::steep::{self, Pixels};
use lanes::*;

/// What eight pixels meet of a cell's means.
pub(crate) struct MetMeans<'a, S: Simd> {
    means: &'a [f32],
    /// Where the rows of either column begin.
    starts: [usize; 2],
    stride: usize,
    /// The second column's share.
    part: f32x8<S>,
}

impl<'a, S: Simd> MetMeans<'a, S> {
    #[inline(always)]
    pub(crate) fn of(simd: S, slab: &'a Slab, places: &Places, cell: usize, at: usize) -> Self {
        Self {
            means: &slab.means,
            starts: places.means[cell].map(|start| (start + at as i64) as usize),
            stride: slab.stride,
            part: splat(simd, places.middles[cell].part),
        }
    }

    #[inline(always)]
    pub(crate) fn row(&self, simd: S, row: usize) -> f32x8<S> {
        let further = row * self.stride;
        between(simd, self.means, [self.starts[0] + further, self.starts[1] + further], self.part)
    }

    /// Adds them, of a cell of some lengths; with what shines `white` of it.
    #[inline(always)]
    pub(crate) fn add(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        opacity: f32x8<S>,
        length: f32x8<S>,
        white: Option<f32x8<S>>,
    ) {
        let depth = opacity * length;
        let share = attenuation_mean(simd, depth);
        let lit = share * length * pixels[3];
        let [r, g, b] = each!(c of 3 => {
            let mut colour = self.row(simd, c);
            if let Some(white) = white {
                colour += white;
            }
            pixels[c] + colour * lit
        });
        // Cells wait for each other by what is visible alone.
        *pixels = [r, g, b, pixels[3] * (splat(simd, 1.0) - depth * share)];
    }
}

/// What eight columns hold between two depths.
struct Held<S: Simd> {
    scalars: [f32x8<S>; 2],
    spread: f32x8<S>,
    gradient: Option<[f32x8<S>; 3]>,
}

impl Classing<'_> {
    /// Means of all that shows.
    #[inline(always)]
    pub(crate) fn find_means<S: Simd>(&self, simd: S, slab: &mut Slab, wanted: &Blocks) {
        let across = slab.blocks_across();
        for block in wanted.iter() {
            for phase in 0..slab.phases {
                let mut known = None;
                for cell in 0..slab.cells() {
                    let at = cell * across + block;
                    if slab.errors[at] != EMPTY {
                        known = self.means_of(simd, slab, (cell, block, phase), known);
                        continue;
                    }
                    known = None;
                    // Views that meet its neighbours may meet it as well.
                    if slab.errors[at.saturating_sub(1)] != EMPTY || slab.errors[at + 1] != EMPTY {
                        forget(simd, slab, slab.mean_start(cell, phase) + block * LANES);
                    }
                }
            }
        }
    }

    /// Mean of the first column after a block, alone: the same whether its own block is looked at or not. It is lit as the last
    /// column before it.
    #[inline(always)]
    pub(crate) fn mean_after<S: Simd>(&self, simd: S, slab: &Slab, cell: usize, block: usize) -> [f32; 4] {
        let next = (block + 1) * LANES;
        let [front, behind] = [cell, cell + 1].map(|depth| slab.row_start(depth, 0) + next);
        let scalars = (slab.scalars[front], slab.scalars[behind]);
        let mut means = [0.0; 4];
        if !(scalars.0 + scalars.1).is_finite() {
            return means;
        }
        let mut spread = 0.0;
        if !slab.spreads.is_empty() {
            spread = 0.5 * (slab.spreads[front] + slab.spreads[behind]);
        }
        let k = mean_alone(self.steep.casting, scalars, spread);
        let mut body = 1.0;
        if let Some(gradient) = gather(simd, slab, (cell, block, slab.phases - 1)).gradient {
            body = self.steep.body(simd, gradient).to_array()[LANES - 1];
        }
        for c in 0..4 {
            means[c] = k[c] * self.thickness * if c < 3 { body } else { 1.0 };
        }
        means
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
        let out = slab.mean_start(cell, phase) + block * LANES;
        let at = cell * slab.blocks_across() + block;
        let met = gather(simd, slab, (cell, block, phase));
        let [front, behind] = met.scalars;
        let around = match Around::between(simd, met.scalars, met.spread) {
            Some(around) if !self.steep.is_vacant(&around) => around,
            Some(_) | None => {
                forget(simd, slab, out);
                return None;
            }
        };
        let sum = front + behind;
        let is_met = sum.simd_eq(sum);
        let thickness = is_met.select(splat(simd, self.thickness), splat(simd, 0.0));
        if !self.steep.is_fine(&around, self.thickness) {
            let k = self.each_alone(simd, &met, thickness);
            slab.errors[at] = f32::INFINITY;
            self.store(simd, slab, out, k, met.gradient);
            return None;
        }
        let lowest = splat(simd, around.low);
        let ends = [is_met.select(front, lowest), is_met.select(behind, lowest)];
        let is_whole = is_met.all_true();
        let fine = self.steep.fine;
        let (shows, back) = if around.spread > 0.0 {
            let k = fine.mean_around(simd, ends, met.spread);
            ([fine.value_at(simd, ends[0]), k, fine.value_at(simd, ends[1])], None)
        } else {
            let near = match looks {
                Some(looks) if is_whole => looks,
                Some(_) | None => fine.look_up(simd, ends[0]),
            };
            let far = fine.look_up(simd, ends[1]);
            ([near.value, mean_between(simd, &near, &far, ends[1] - ends[0]), far.value], Some(far))
        };
        slab.errors[at] = slab.errors[at].max(largest(steep::disorder(simd, shows, thickness)));
        let k = each!(c of 4 => shows[1][c] * thickness);
        self.store(simd, slab, out, k, met.gradient);
        if is_whole { back } else { None }
    }

    /// Means by the whole table, column by column.
    #[inline(always)]
    fn each_alone<S: Simd>(&self, simd: S, met: &Held<S>, thickness: f32x8<S>) -> [f32x8<S>; 4] {
        let [front, behind] = [met.scalars[0].to_array(), met.scalars[1].to_array()];
        let (spread, thickness) = (met.spread.to_array(), thickness.to_array());
        let mut means = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            if thickness[lane] == 0.0 {
                continue;
            }
            let k = mean_alone(self.steep.casting, (front[lane], behind[lane]), spread[lane]);
            for c in 0..4 {
                means[c][lane] = k[c] * thickness[lane];
            }
        }
        each!(c of 4 => f32x8::load_array(simd, means[c]))
    }

    /// Keeps the means of eight columns, lit but for the highlight, which views differ in.
    #[inline(always)]
    fn store<S: Simd>(
        &self,
        simd: S,
        slab: &mut Slab,
        out: usize,
        k: [f32x8<S>; 4],
        gradient: Option<[f32x8<S>; 3]>,
    ) {
        let stride = slab.stride;
        let means = &mut slab.means;
        let mut body = splat(simd, 1.0);
        if let Some(gradient) = gradient {
            body = self.steep.body(simd, gradient);
            for (axis, along) in gradient.into_iter().enumerate() {
                let start = out + (PLAIN_ROWS + axis) * stride;
                along.store_slice(&mut means[start..start + LANES]);
            }
        }
        for (c, k) in [k[0] * body, k[1] * body, k[2] * body, k[3]].into_iter().enumerate() {
            let start = out + c * stride;
            k.store_slice(&mut means[start..start + LANES]);
        }
    }
}

#[inline(always)]
fn gather<S: Simd>(simd: S, slab: &Slab, (cell, block, phase): (usize, usize, usize)) -> Held<S> {
    let [front, back] = [cell, cell + 1].map(|depth| slab.row_start(depth, phase) + block * LANES);
    let half = splat(simd, 0.5);
    let mut spread = splat(simd, 0.0);
    if !slab.spreads.is_empty() {
        spread = half * (load(simd, &slab.spreads, front) + load(simd, &slab.spreads, back));
    }
    let mut gradient = None;
    if !slab.gradients.is_empty() {
        let [front, back] = [cell, cell + 1].map(|depth| 3 * slab.row_start(depth, phase) + block * LANES);
        gradient = Some(each!(axis of 3 => {
            let row = axis * slab.stride;
            half * (load(simd, &slab.gradients, front + row) + load(simd, &slab.gradients, back + row))
        }));
    }
    Held { scalars: [load(simd, &slab.scalars, front), load(simd, &slab.scalars, back)], spread, gradient }
}

/// Notes that nothing shows in eight columns.
#[inline(always)]
fn forget<S: Simd>(simd: S, slab: &mut Slab, out: usize) {
    let nothing = splat(simd, 0.0);
    for row in 0..slab.mean_rows {
        let start = out + row * slab.stride;
        nothing.store_slice(&mut slab.means[start..start + LANES]);
    }
}
