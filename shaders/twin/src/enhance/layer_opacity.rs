//! Layer opacity by view direction (LFD section 4).

use super::band::band_between;
use super::hooks::{Hooks, LinkState, Place};
use super::link::{UNUSED, corners, scaled, with, xyz};
use crate::composite::Sample;
use crate::scene::Constants;
use crate::{Real, vector::Vec3};
use optics::LayerOpacity;

impl Hooks for LayerOpacity {
    fn constants(&self) -> Constants<f64> {
        [
            corners(&self.band),
            with(self.axis_in_display, 0.0),
            [self.facing.low, self.facing.high, self.away, self.toward],
            UNUSED,
        ]
    }

    /// x: μ − 1.
    #[inline(always)]
    fn start<F: Real>(link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
        let [low, high, away, toward] = link[2];
        let aligned = xyz(&link[1]).dot(view).smoothstep(low, high);
        [away + (toward - away) * aligned - F::ONE, F::ZERO, F::ZERO, F::ZERO]
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
        scaled(sample, F::ONE + band_between(&link[0], place.scalars) * state.weights[0])
    }
}
