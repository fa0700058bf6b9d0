//! Clip plane with view-dependent context (LFD section 4).

use super::hooks::{Hooks, LinkState, Place};
use super::link::{UNUSED, scaled, with, xyz};
use crate::composite::Sample;
use crate::ray::{Ray, far};
use crate::scene::Constants;
use crate::{Real, vector::Vec3};
use optics::ClipPlane;

impl Hooks for ClipPlane {
    fn constants(&self) -> Constants<f64> {
        let offset = self.normal_in_display.dot(self.point_in_display);
        let held = held_from(self.boost);
        // At less strength the boost may not be reached: then on the plane itself.
        let reached = ((1.0 - held) / self.strength).min(1.0);
        [
            with(self.normal_in_display, offset),
            [self.context.low, self.context.high, self.thickness_m, held],
            [self.strength, offset - self.thickness_m * (1.0 - reached), 0.0, 0.0],
            UNUSED,
        ]
    }

    /// x: factor of what is cut away.
    #[inline(always)]
    fn start<F: Real>(link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
        let aside = F::ONE - (-xyz(&link[0]).dot(view)).most(F::ZERO);
        let context = aside.smoothstep(link[1][0], link[1][1]);
        [F::ONE + (context - F::ONE) * link[2][0], F::ZERO, F::ZERO, F::ZERO]
    }

    #[inline(always)]
    fn breaks<F: Real>(link: &Constants<F>, _: Vec3<F>, ray: &Ray<F>) -> [F; 3] {
        if link[2][0] <= F::ZERO {
            return [far(); 3];
        }
        let (normal, offset) = (xyz(&link[0]), link[0][3]);
        [offset, offset - link[1][2], link[2][1]].map(|offset| ray.plane_crossing(normal, offset))
    }

    #[inline(always)]
    fn acts<F: Real>(link: &Constants<F>, state: &LinkState<F>, (point, _): (Vec3<F>, F)) -> bool {
        let above = above(link, point);
        if above > F::ZERO { state.weights[0] != F::ONE } else { above > -link[1][2] }
    }

    #[inline(always)]
    fn at<F: Real>(
        link: &Constants<F>,
        state: &LinkState<F>,
        sample: Sample<F>,
        place: &Place<F>,
    ) -> Sample<F> {
        let [_, _, thickness, held] = link[1];
        let above = above(link, place.point);
        if above > F::ZERO {
            return scaled(sample, state.weights[0]);
        }
        if above <= -thickness {
            return sample;
        }
        let sliced = link[2][0] * above.smoothstep(-thickness, F::ZERO);
        // y at both ends; 1 / (a b) is the mean of 1 / y² between them.
        let reach = xyz(&link[0]).dot(place.reach);
        let edge = |above: F| {
            let near = (F::ONE + above / thickness).most(F::ZERO).least(F::ONE);
            (F::ONE - link[2][0] * near).most(held)
        };
        let (a, b) = (edge(above - reach), edge(above + reach));
        let changed = scaled(sample, F::ONE / (a * b) - F::of(2.0) + (a + b));
        Sample { lit: changed.lit * (F::ONE - sliced), ..changed }
    }
}

/// δ: metres before the plane.
#[inline(always)]
fn above<F: Real>(link: &Constants<F>, point: Vec3<F>) -> F {
    xyz(&link[0]).dot(point) - link[0][3]
}

/// The y from which on the factor of the extinction is less than `boost`.
fn held_from(boost: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // As many halvings as an f64 has digits.
    for _ in 0..53 {
        let middle = 0.5 * (low + high);
        *(if ClipPlane::emphasis(middle) > boost { &mut low } else { &mut high }) = middle;
    }
    high
}
