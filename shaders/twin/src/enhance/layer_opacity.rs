//! Layer opacity by view direction (LFD section 4).

use super::band::band_between;
use super::hooks::{Hooks, LinkState};
use super::link::{UNUSED, corners, scaled, with, xyz};
use super::place::Place;
use crate::composite::Sample;
use crate::real::Number;
use crate::scene::Constants;
use crate::vector::Vec3;
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
    fn start<N: Number>(link: &Constants<N>, view: Vec3<N>) -> [N; 4] {
        let [low, high, away, toward] = link[2];
        let aligned = xyz(&link[1]).dot(view).smoothstep(low, high);
        let (zero, one) = (aligned.alike(0.0), aligned.alike(1.0));
        [away + (toward - away) * aligned - one, zero, zero, zero]
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
        let weight = state.weights[0];
        scaled(sample, weight.alike(1.0) + band_between(&link[0], place.scalars) * weight)
    }
}
