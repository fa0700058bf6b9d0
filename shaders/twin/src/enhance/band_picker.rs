//! View-dependent band picker (LFD section 4).

use super::band::{band_between, band_most};
use super::hooks::{Hooks, LinkState, Place};
use super::link::{UNUSED, corners, scaled, with, xyz};
use crate::composite::Sample;
use crate::importance::Importance;
use crate::scene::Constants;
use crate::{Real, vector::Vec3};
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
    fn start<F: Real>(link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
        let aligned = xyz(&link[1]).dot(view).most(F::ZERO).smoothstep(link[2][0], link[2][1]);
        [link[1][3] * aligned, F::ZERO, F::ZERO, F::ZERO]
    }

    #[inline(always)]
    fn acts<F: Real>(_: &Constants<F>, state: &LinkState<F>, _: (Vec3<F>, F)) -> bool {
        state.weights[0] != F::ZERO
    }

    #[inline(always)]
    fn at<F: Real>(
        link: &Constants<F>,
        state: &LinkState<F>,
        sample: Sample<F>,
        place: &Place<F>,
    ) -> Sample<F> {
        let weight = state.weights[0];
        let picked = band_between(&link[0], place.scalars);
        let changed = scaled(sample, F::ONE - weight * (F::ONE - picked));
        if !place.has_importance {
            return changed;
        }
        let toward = |from: F, to: F| from + (to - from) * weight;
        let Importance { mean, most } = sample.importance;
        let most = toward(most, band_most(&link[0], place.scalars));
        Sample { importance: Importance { mean: toward(mean, picked), most }, ..changed }
    }
}
