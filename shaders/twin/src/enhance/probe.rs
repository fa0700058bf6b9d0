//! Context-preserving probe (LFD eq. 4 and 5).

use super::hooks::{Hooks, LinkState, Place};
use super::link::{scaled, with, xyz};
use crate::composite::Sample;
use crate::gradient::LEAST_SQUARE;
use crate::ray::{Ray, far};
use crate::scene::Constants;
use crate::{Real, vector::Vec3};
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
    fn start<F: Real>(link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
        let aligned = xyz(&link[1]).dot(view).most(F::ZERO).smoothstep(link[2][0], link[2][1]);
        [aligned, F::ZERO, F::ZERO, F::ZERO]
    }

    /// Inside the sphere.
    #[inline(always)]
    fn looks<F: Real>(state: &LinkState<F>, t: F) -> bool {
        is_inside(state, t)
    }

    /// Where the ray enters and leaves the sphere, and where it crosses the plane through the centre.
    #[inline(always)]
    fn breaks<F: Real>(link: &Constants<F>, view: Vec3<F>, ray: &Ray<F>) -> [F; 3] {
        let (centre, radius) = (xyz(&link[0]), link[0][3]);
        let from_centre = ray.origin_in_display - centre;
        let nearest = -from_centre.dot(ray.direction_in_display);
        let aside = from_centre + ray.direction_in_display * nearest;
        let square = radius * radius - aside.dot(aside);
        if link[1][3] <= F::ZERO || square <= F::ZERO {
            return [far(); 3];
        }
        let half = square.sqrt();
        [nearest - half, ray.plane_crossing(view, view.dot(centre)), nearest + half]
    }

    #[inline(always)]
    fn acts<F: Real>(_: &Constants<F>, state: &LinkState<F>, (_, t): (Vec3<F>, F)) -> bool {
        is_inside(state, t)
    }

    #[inline(always)]
    fn at<F: Real>(
        link: &Constants<F>,
        state: &LinkState<F>,
        sample: Sample<F>,
        place: &Place<F>,
    ) -> Sample<F> {
        let (from_centre, radius) = (place.point - xyz(&link[0]), link[0][3]);
        if from_centre.dot(from_centre) >= radius * radius {
            return sample;
        }
        let past = from_centre.dot(place.view);
        let near = F::ONE - (past * past) / (radius * radius);
        let edge = edge(link, state.weights[0], &sample, place);
        let (mut opacity, mut intensity) = (edge * near, F::ONE - edge);
        if past >= F::ZERO {
            opacity = edge + (F::ONE - edge) * (F::ONE - near);
            intensity = F::ONE - edge + edge * (F::ONE - near);
        }
        let strength = link[1][3];
        let changed = scaled(sample, F::ONE + (opacity - F::ONE) * strength);
        let brightness = changed.brightness * (F::ONE + (intensity - F::ONE) * strength);
        Sample { brightness, ..changed }
    }
}

/// Whether t lies between where the ray enters the sphere and where it leaves it.
#[inline(always)]
fn is_inside<F: Real>(state: &LinkState<F>, t: F) -> bool {
    t > state.breaks[0] && t < state.breaks[2]
}

/// η: how much of an edge a sample is.
#[inline(always)]
fn edge<F: Real>(link: &Constants<F>, aligned: F, sample: &Sample<F>, place: &Place<F>) -> F {
    let square = place.gradient.dot(place.gradient);
    if square < F::of(LEAST_SQUARE) {
        return F::ZERO;
    }
    let size = square.sqrt();
    let flat_share = F::ONE - (place.gradient.dot(place.view).abs() / size).least(F::ONE);
    let importance = if place.has_importance { sample.importance.mean } else { F::ONE };
    let strength = (importance * size / link[2][2]).smoothstep(link[3][0], link[3][1]);
    aligned * strength * (flat_share * flat_share) * (flat_share * flat_share)
}
