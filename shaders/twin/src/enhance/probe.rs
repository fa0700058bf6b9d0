//! Context-preserving probe (LFD eq. 4 and 5).

use super::hooks::{Hooks, LinkState};
use super::link::{scaled, with, xyz};
use super::place::Place;
use crate::composite::Sample;
use crate::gradient::LEAST_SQUARE;
use crate::ray::{FAR, Line};
use crate::real::Number;
use crate::scene::Constants;
use crate::vector::Vec3;
use optics::Probe;

impl Hooks for Probe {
    fn constants(&self) -> Constants<f64> {
        [
            with(self.centre_in_display, self.radius_m),
            with(self.axis_in_display, self.strength),
            [self.facing.low, self.facing.high, self.gradient_most, 0.0],
            [self.edges.low, self.edges.high, 0.0, 0.0],
        ]
    }

    /// x: ω_a.
    #[inline(always)]
    fn start<N: Number>(link: &Constants<N>, view: Vec3<N>) -> [N; 4] {
        let aligned = xyz(&link[1]).dot(view);
        let zero = aligned.alike(0.0);
        [aligned.most(zero).smoothstep(link[2][0], link[2][1]), zero, zero, zero]
    }

    /// Inside the sphere.
    #[inline(always)]
    fn looks<N: Number>(state: &LinkState<N>, t: N) -> N {
        inside(state, t)
    }

    /// Where the ray enters and leaves the sphere, and where it crosses the plane through the centre.
    #[inline(always)]
    fn breaks<N: Number>(link: &Constants<N>, view: Vec3<N>, line: &Line<N>) -> [N; 3] {
        let (centre, radius, strength) = (xyz(&link[0]), link[0][3], link[1][3]);
        let (zero, far) = (radius.alike(0.0), radius.alike(FAR));
        let from_centre = line.origin - centre;
        let nearest = -from_centre.dot(line.direction);
        let aside = from_centre + line.direction * nearest;
        let square = radius * radius - aside.dot(aside);
        // Above 0 if the ray meets the sphere of a probe that does something.
        let meets = square.least(strength);
        if !zero.is_any_below(meets) {
            return [far; 3];
        }
        let half = square.sqrt();
        let middle = line.plane_crossing(view, view.dot(centre));
        [
            zero.choose(meets, nearest - half, far),
            zero.choose(meets, middle, far),
            zero.choose(meets, nearest + half, far),
        ]
    }

    #[inline(always)]
    fn acts<N: Number>(_: &Constants<N>, state: &LinkState<N>, (_, t): (Vec3<N>, N)) -> N {
        inside(state, t)
    }

    #[inline(always)]
    fn at<N: Number>(
        link: &Constants<N>,
        state: &LinkState<N>,
        sample: Sample<N>,
        place: &Place<N>,
    ) -> Sample<N> {
        let (from_centre, radius, strength) = (place.point - xyz(&link[0]), link[0][3], link[1][3]);
        let (square, radius_square) = (from_centre.dot(from_centre), radius * radius);
        let (zero, one) = (square.alike(0.0), square.alike(1.0));
        if radius_square.is_below(square) {
            return sample;
        }
        let past = from_centre.dot(place.view);
        let near = one - (past * past) / radius_square;
        let edge = edge(link, state.weights[0], &sample, place);
        let opacity = past.choose(zero, edge * near, edge + (one - edge) * (one - near));
        let intensity = past.choose(zero, one - edge, one - edge + edge * (one - near));
        let opacity = one + (opacity - one) * strength;
        let intensity = one + (intensity - one) * strength;
        let changed = scaled(sample, square.choose(radius_square, opacity, one));
        Sample { brightness: changed.brightness * square.choose(radius_square, intensity, one), ..changed }
    }
}

/// Above 0 between where a ray enters the sphere and where it leaves it.
#[inline(always)]
fn inside<N: Number>(state: &LinkState<N>, t: N) -> N {
    (t - state.breaks[0]).least(state.breaks[2] - t)
}

/// η: how much of an edge a sample is.
#[inline(always)]
fn edge<N: Number>(link: &Constants<N>, aligned: N, sample: &Sample<N>, place: &Place<N>) -> N {
    let square = place.gradient.dot(place.gradient);
    let (zero, one, least) = (square.alike(0.0), square.alike(1.0), square.alike(LEAST_SQUARE));
    if square.is_below(least) {
        return zero;
    }
    let size = square.sqrt();
    let flat_share = one - (place.gradient.dot(place.view).abs() / size).least(one);
    let importance = if place.has_importance { sample.importance.mean } else { one };
    let strength = (importance * size / link[2][2]).smoothstep(link[3][0], link[3][1]);
    let edge = aligned * strength * (flat_share * flat_share) * (flat_share * flat_share);
    square.choose(least, zero, edge)
}
