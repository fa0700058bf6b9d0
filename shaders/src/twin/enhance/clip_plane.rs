//! Clip plane with view-dependent context (LFD section 4).

use super::hooks::{Hooks, LinkState, Place};
use super::link::{UNUSED, scaled, with, xyz};
use crate::twin::composite::Sample;
use crate::twin::ray::{Ray, far};
use crate::twin::scene::Constants;
use crate::twin::{Real, vector::Vec3};
use optics::ClipPlane;

impl Hooks for ClipPlane {
    fn constants(&self) -> Constants<f64> {
        let offset = self.normal_in_display.dot(self.point_in_display);
        [
            with(self.normal_in_display, offset),
            [self.context.low, self.context.high, self.thickness_m, self.boost],
            [self.strength, 0.0, 0.0, 0.0],
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
        [ray.plane_crossing(normal, offset), ray.plane_crossing(normal, offset - link[1][2]), far()]
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
        let [_, _, thickness, boost] = link[1];
        let above = above(link, place.point);
        if above > F::ZERO {
            return scaled(sample, state.weights[0]);
        }
        if above <= -thickness {
            return sample;
        }
        let sliced = link[2][0] * above.smoothstep(-thickness, F::ZERO);
        let changed = scaled(sample, F::ONE + (boost - F::ONE) * sliced);
        Sample { lit: changed.lit * (F::ONE - sliced), ..changed }
    }
}

/// δ: metres before the plane.
#[inline(always)]
fn above<F: Real>(link: &Constants<F>, point: Vec3<F>) -> F {
    xyz(&link[0]).dot(point) - link[0][3]
}
