//! Cells whose samples lie too far apart for what they show: rays of a view sample the volume for themselves, eight side by side.

use crate::around::Around;
use crate::fine::{FineTable, Looked, mean_between};
use crate::near::{Near, Points, Samples};
use crate::places::Places;
use crate::slab::LANES;
use crate::steep::{Cell, Light, Pixels, composite};
use crate::sweep::Sweep;
use crate::view_row::ViewRow;
use lanes::*;
use std::cell::Cell as Count;

/// The largest error of a segment's light that scalars half-way make, in tolerances; half a segment errs a quarter of it.
const HALFWAY_ERROR: f32 = 30.0;

/// Halvings of a cell that nothing less is asked of than the most that its samples are known to need.
const UNASKED: usize = 2;

/// From so many halvings of a cell on, light falls on both halves of a segment alike.
const LIGHT_HALVINGS: usize = 2;

/// A segment of which only one end is known is halved until the cell was halved so many times.
const TORN_HALVINGS: usize = 4;

/// Where less of a ray's light than so many tolerances comes from a segment, it is lit as its middle is; where more than the other, it
/// is halved.
const LEAST_LIT: f32 = 500.0;
const MOST_LIT: f32 = 3000.0;

/// What eight rays meet at a depth.
#[derive(Clone, Copy)]
pub(crate) struct End<S: Simd> {
    samples: Samples<S>,
    /// What the scalars look up, once that is asked for.
    looked: Option<Looked<S>>,
}

impl<S: Simd> End<S> {
    #[inline(always)]
    fn looked(&mut self, simd: S, fine: &FineTable) -> Looked<S> {
        let looked = match self.looked {
            Some(looked) => looked,
            None => fine.look_up(simd, self.samples.scalars),
        };
        self.looked = Some(looked);
        looked
    }
}

/// A cell as eight rays cross it.
struct Crossing<'a, 'b, S: Simd> {
    sweep: &'a Sweep<'b>,
    near: &'a Near<'b>,
    view: &'a ViewRow,
    /// The leaves around it.
    leaves: &'a [usize],
    /// The first pixel.
    at: usize,
    /// z of its front and back.
    z: [f64; 2],
    /// Optical depth of all of it where the table says 1.
    thickness: f32x8<S>,
    /// The most of it.
    thickest: f32,
    halfway: [f32x8<S>; 3],
    /// It is halved at most so many times.
    most: usize,
    /// Samples of eight rays each.
    samples: Count<u32>,
}

impl Sweep<'_> {
    /// Adds a cell of eight pixels that is to be halved up to `spacing` times. What its back shows, and the cell behind it.
    #[inline(never)]
    pub(crate) fn add_alone<S: Simd>(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        view: &ViewRow,
        places: &mut Places,
        (cell, at, spacing, reach): (usize, usize, usize, f32),
        front: Option<End<S>>,
    ) -> Option<(usize, End<S>)> {
        outlined!(simd => {
        let near = self.near?;
        if places.leaves_of != Some(at) {
            places.find_leaves(near, at);
        }
        let thickness = splat(simd, self.thickness) * load(simd, &view.lengths, at);
        let crossing = Crossing {
            sweep: self,
            near,
            view,
            leaves: &places.leaves,
            at,
            z: [self.slab.depths[cell].z, self.slab.depths[cell + 1].z],
            thickness,
            thickest: largest(thickness),
            halfway: self.halfway(simd, view, at),
            most: spacing,
            samples: Count::new(0),
        };
        let halvings = spacing.saturating_sub(UNASKED);
        let mut front = match front {
            Some(front) => front,
            None => crossing.end(simd, 0.0),
        };
        let parts = 1usize << halvings;
        for part in 0..parts {
            let share = [part, part + 1].map(|part| part as f64 / parts as f64);
            let mut back = crossing.end(simd, share[1]);
            if !crossing.is_vacant(simd, [&front, &back], reach) {
                crossing.add(simd, pixels, [&mut front, &mut back], share, halvings);
            }
            front = back;
            if self.steep.are_closed(simd, pixels[3]) {
                break;
            }
        }
        let samples = crossing.samples.get();
        places.samples += u64::from(samples) * LANES as u64;
        Some((cell + 1, front))
        })
    }
}

impl<S: Simd> Crossing<'_, '_, S> {
    /// Whether nothing shows of scalars between those of two ends, or so far around them.
    #[inline(always)]
    fn is_vacant(&self, simd: S, [front, back]: [&End<S>; 2], reach: f32) -> bool {
        let Some(around) = Around::all(simd, [&front.samples, &back.samples]) else { return true };
        self.sweep.steep.is_vacant(&Around { spread: around.spread + reach, ..around })
    }

    /// Whether the fine table tells all that a share of the cell shows.
    #[inline(always)]
    fn is_fine<const COUNT: usize>(&self, simd: S, samples: [&Samples<S>; COUNT], share: f32) -> bool {
        if self.sweep.is_fine {
            return true;
        }
        let Some(around) = Around::all(simd, samples) else { return true };
        self.sweep.steep.is_fine(&around, self.thickest * share)
    }

    /// What lies a share of the way through the cell.
    #[inline(always)]
    fn end(&self, simd: S, share: f64) -> End<S> {
        self.samples.set(self.samples.get() + 1);
        End { samples: self.near.samples(simd, self.points(simd, share), self.leaves), looked: None }
    }

    #[inline(always)]
    fn z_at(&self, share: f64) -> f64 {
        self.z[0] + (self.z[1] - self.z[0]) * share
    }

    #[inline(always)]
    fn points(&self, simd: S, share: f64) -> Points<S> {
        let z = self.z_at(share);
        let [first, each] = self.sweep.lines;
        let each = each[0] + each[1] * z;
        let x = first[0] + first[1] * z + each * self.at as f64;
        Points { x: splat(simd, x as f32) + splat(simd, each as f32) * ramp(simd), z }
    }

    /// Adds a segment, after so many halvings of the cell; by halves where what lies half-way makes too much of a difference.
    #[inline(never)]
    fn add(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        [front, back]: [&mut End<S>; 2],
        [from, to]: [f64; 2],
        halvings: usize,
    ) {
        outlined!(simd => {
        let (sweep, steep) = (self.sweep, &self.sweep.steep);
        let (zero, half, one) = (splat(simd, 0.0), splat(simd, 0.5), splat(simd, 1.0));
        let half_way = 0.5 * (from + to);
        let mut middle = self.end(simd, half_way);
        let fine = steep.fine;
        let [s0, s1, s2] = [front.samples, middle.samples, back.samples];
        let is_spread = s0.spreads.max(s1.spreads).max(s2.spreads).simd_gt(zero).any_true();
        let [mut near, mut far] = [[zero; 4]; 2];
        let (whole, a, b);
        if is_spread {
            whole = self.mean_around(simd, [&s0, &s2]);
            (a, b) = (self.mean_around(simd, [&s0, &s1]), self.mean_around(simd, [&s1, &s2]));
        } else {
            let looked = [front.looked(simd, fine), middle.looked(simd, fine), back.looked(simd, fine)];
            whole = mean_between(simd, &looked[0], &looked[2], s2.scalars - s0.scalars);
            a = mean_between(simd, &looked[0], &looked[1], s1.scalars - s0.scalars);
            b = mean_between(simd, &looked[1], &looked[2], s2.scalars - s1.scalars);
            (near, far) = (looked[0].value, looked[2].value);
        }
        let mean = each!(c of 4 => half * (a[c] + b[c]));
        let is_fine = self.is_fine(simd, [&s0, &s1, &s2], (to - from) as f32);
        if is_fine && !mean[3].max(whole[3]).simd_gt(zero).any_true() {
            return;
        }
        let visible = pixels[3];
        let is_open = visible.simd_ge(splat(simd, steep.casting.scene.termination));
        let is_met = s0.known & s1.known & s2.known & is_open;
        let mut thickness = self.thickness * splat(simd, (to - from) as f32);
        if sweep.slab.is_outer {
            thickness *= sweep.share_between(simd, self.view, [self.z_at(from), self.z_at(to)], self.at);
        }
        let thickness = is_met.select(thickness, zero);
        let off = each!(c of 4 => (whole[c] - mean[c]).abs());
        let off = off[0].max(off[1]).max(off[2]).max(off[3]);
        let error = off * thickness * visible / (one + mean[3] * thickness);
        let tolerance = steep.casting.scene.tolerance;
        let is_off = error.simd_gt(splat(simd, tolerance * HALFWAY_ERROR)).any_true();
        let is_lit = sweep.slab.gradient_rows > 0 && halvings < LIGHT_HALVINGS;
        let contribution = if is_lit { largest(mean[3] * thickness * visible) } else { 0.0 };
        // Of what the fine table leaves out nobody knows how much it errs.
        let is_coarse = halvings < self.most && (is_off || !is_fine);
        let is_torn =
            ((s0.known & !s2.known) | (s2.known & !s0.known)).any_true() && halvings < TORN_HALVINGS;
        if is_coarse || is_torn || contribution > MOST_LIT * tolerance {
            self.add(simd, pixels, [front, &mut middle], [from, half_way], halvings + 1);
            self.add(simd, pixels, [&mut middle, back], [half_way, to], halvings + 1);
            return;
        }
        if is_spread || !is_fine {
            self.add_halves(simd, pixels, [*front, middle, *back], half * thickness, [from, to]);
            return;
        }
        let is_lit_once = contribution < LEAST_LIT * tolerance;
        let ends = [near, mean, far];
        if is_lit_once && steep.is_one(simd, ends, thickness, pixels[3]) {
            let light = self.light(simd, half_way);
            composite(simd, pixels, mean, thickness, light);
            return;
        }
        let thickness = half * thickness;
        if steep.parts(simd, (a, b), thickness, pixels[3]) > 1.0 {
            self.add_halves(simd, pixels, [*front, middle, *back], thickness, [from, to]);
            return;
        }
        let lights = if is_lit_once {
            [self.light(simd, half_way); 2]
        } else {
            [self.light(simd, 0.5 * (from + half_way)), self.light(simd, 0.5 * (half_way + to))]
        };
        composite(simd, pixels, a, thickness, lights[0]);
        composite(simd, pixels, b, thickness, lights[1]);
        })
    }

    /// The gradient at a share of the way, where light falls.
    #[inline(always)]
    fn gradient(&self, simd: S, share: f64) -> Option<[f32x8<S>; 3]> {
        let has_light = self.sweep.slab.gradient_rows > 0;
        if !has_light {
            return None;
        }
        Some(self.near.gradients(simd, self.points(simd, share), self.leaves))
    }

    #[inline(always)]
    fn light(&self, simd: S, share: f64) -> Option<Light<S>> {
        let gradient = self.gradient(simd, share)?;
        Some(self.sweep.steep.light(simd, gradient, self.halfway))
    }

    /// Adds the halves of a segment, each in as many parts as the order of what it shows asks for, and lit as its middle is.
    #[inline(never)]
    fn add_halves(
        &self,
        simd: S,
        pixels: &mut Pixels<S>,
        mut ends: [End<S>; 3],
        thickness: f32x8<S>,
        [from, to]: [f64; 2],
    ) {
        outlined!(simd => {
        let sweep = self.sweep;
        for half in 0..2 {
            let mut gradient = None;
            if let Some(g) = self.gradient(simd, from + (to - from) * (0.25 + 0.5 * half as f64)) {
                gradient = Some(each!(axis of 3 => [g[axis], g[axis]]));
            }
            let met = [ends[half].samples, ends[half + 1].samples];
            let scalars = [met[0].scalars, met[1].scalars];
            let spread = splat(simd, 0.5) * (met[0].spreads + met[1].spreads);
            if !self.is_fine(simd, [&met[0], &met[1]], 0.5 * (to - from) as f32) {
                sweep.add_each(simd, pixels, (scalars, spread, thickness), gradient, self.at);
                continue;
            }
            let cell = Cell { scalars, thickness, gradient };
            if spread.simd_gt(splat(simd, 0.0)).any_true() {
                sweep.steep.add_spread(simd, pixels, &cell, spread, self.halfway);
                continue;
            }
            let fine = sweep.steep.fine;
            let looked = [ends[half].looked(simd, fine), ends[half + 1].looked(simd, fine)];
            sweep.steep.add(simd, pixels, &cell, [&looked[0], &looked[1]], self.halfway);
        }
        })
    }

    /// The mean between two depths where samples stand for others.
    #[inline(always)]
    fn mean_around(&self, simd: S, [a, b]: [&Samples<S>; 2]) -> [f32x8<S>; 4] {
        let spread = splat(simd, 0.5) * (a.spreads + b.spreads);
        self.sweep.steep.fine.mean_around(simd, [a.scalars, b.scalars], spread)
    }
}
