//! View-dependent band picker (LFD section 4).

use super::band::{band_between, band_most};
use super::hooks::{Hooks, LinkState};
use super::link::{UNUSED, corners, scaled, with, xyz};
use super::place::Place;
use crate::composite::Sample;
use crate::importance::Importance;
use crate::real::Number;
use crate::scene::Constants;
use crate::vector::Vec3;
use optics::BandPicker;

impl Hooks for BandPicker {
    fn constants(&self) -> Constants<f64> {
        [
            corners(&self.band),
            with(self.axis_in_display, self.strength),
            [self.facing.low, self.facing.high, 0.0, 0.0],
            UNUSED,
        ]
    }

    /// x: weight of the change.
    #[inline(always)]
    fn start<N: Number>(link: &Constants<N>, view: Vec3<N>) -> [N; 4] {
        let aligned = xyz(&link[1]).dot(view);
        let zero = aligned.alike(0.0);
        [link[1][3] * aligned.most(zero).smoothstep(link[2][0], link[2][1]), zero, zero, zero]
    }

    #[inline(always)]
    fn acts<N: Number>(_: &Constants<N>, state: &LinkState<N>, _: (Vec3<N>, N)) -> N {
        state.weights[0].abs()
    }

    #[inline(always)]
    fn at<N: Number>(
        link: &Constants<N>,
        state: &LinkState<N>,
        sample: Sample<N>,
        place: &Place<N>,
    ) -> Sample<N> {
        let (weight, one) = (state.weights[0], state.weights[0].alike(1.0));
        let picked = band_between(&link[0], place.scalars);
        let changed = scaled(sample, one - weight * (one - picked));
        if !place.has_importance {
            return changed;
        }
        let Importance { mean, most } = sample.importance;
        let importance = Importance {
            mean: mean + (picked - mean) * weight,
            most: most + (band_most(&link[0], place.scalars) - most) * weight,
        };
        Sample { importance, ..changed }
    }
}
