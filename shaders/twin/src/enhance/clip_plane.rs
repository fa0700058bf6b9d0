//! Clip plane with view-dependent context (LFD section 4).

use super::hooks::{Hooks, LinkState};
use super::link::{UNUSED, scaled, with, xyz};
use super::place::Place;
use crate::composite::Sample;
use crate::ray::{FAR, Line};
use crate::real::Number;
use crate::scene::Constants;
use crate::vector::Vec3;
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
    fn start<N: Number>(link: &Constants<N>, view: Vec3<N>) -> [N; 4] {
        let towards = xyz(&link[0]).dot(view);
        let (zero, one) = (towards.alike(0.0), towards.alike(1.0));
        let context = (one - (-towards).most(zero)).smoothstep(link[1][0], link[1][1]);
        [one + (context - one) * link[2][0], zero, zero, zero]
    }

    #[inline(always)]
    fn breaks<N: Number>(link: &Constants<N>, _: Vec3<N>, line: &Line<N>) -> [N; 3] {
        let (normal, offset, strength) = (xyz(&link[0]), link[0][3], link[2][0]);
        let (zero, far) = (strength.alike(0.0), strength.alike(FAR));
        let surface = line.plane_crossing(normal, offset);
        let [begin, held] =
            [line.plane_crossing(normal, offset - link[1][2]), line.plane_crossing(normal, link[2][1])];
        [
            zero.choose(strength, surface, far),
            zero.choose(strength, begin, far),
            zero.choose(strength, held, far),
        ]
    }

    #[inline(always)]
    fn acts<N: Number>(link: &Constants<N>, state: &LinkState<N>, (point, _): (Vec3<N>, N)) -> N {
        let (above, thickness) = (above(link, point), link[1][2]);
        let (zero, one) = (above.alike(0.0), above.alike(1.0));
        zero.choose(above, (state.weights[0] - one).abs(), above + thickness)
    }

    #[inline(always)]
    fn at<N: Number>(
        link: &Constants<N>,
        state: &LinkState<N>,
        sample: Sample<N>,
        place: &Place<N>,
    ) -> Sample<N> {
        let [_, _, thickness, held] = link[1];
        let (above, strength) = (above(link, place.point), link[2][0]);
        let (zero, one, two) = (above.alike(0.0), above.alike(1.0), above.alike(2.0));
        if zero.is_below(above) {
            return scaled(sample, state.weights[0]);
        }
        if above.is_below(-thickness) {
            return sample;
        }
        let sliced = strength * above.smoothstep(-thickness, zero);
        // y at both ends; 1 / (a b) is the mean of 1 / y² between them.
        let reach = xyz(&link[0]).dot(place.reach);
        let a = edge(link, above - reach).most(held);
        let b = edge(link, above + reach).most(held);
        let near = one / (a * b) - two + (a + b);
        let (near, unsliced) =
            ((-thickness).choose(above, near, one), (-thickness).choose(above, one - sliced, one));
        let factor = zero.choose(above, state.weights[0], near);
        let unsliced = zero.choose(above, one, unsliced);
        let changed = scaled(sample, factor);
        Sample { lit: changed.lit * unsliced, ..changed }
    }
}

/// δ: metres before the plane.
#[inline(always)]
fn above<N: Number>(link: &Constants<N>, point: Vec3<N>) -> N {
    xyz(&link[0]).dot(point) - link[0][3]
}

/// y so many metres before the plane.
#[inline(always)]
fn edge<N: Number>(link: &Constants<N>, above: N) -> N {
    let (zero, one) = (above.alike(0.0), above.alike(1.0));
    let near = (one + above / link[1][2]).most(zero).least(one);
    one - link[2][0] * near
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
