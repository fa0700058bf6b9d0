//! Maximum Importance Difference Accumulation as published (LFD eq. 3): β = 1 − γ max(ι − ι_max, 0).

use super::mimda::Form;
use super::{Accumulated, Light, Sample};
use crate::{Casting, Real};

/// Twin of `wgsl/composite/mimda_paper.wgsl`.
pub struct Paper;

impl Form for Paper {
    // The equation is one of steps, and its picture depends on them: it is applied once per step.
    const ONCE_PER_STEP: bool = true;

    #[inline(always)]
    fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F {
        F::ONE - gamma * (importance - largest).most(F::ZERO)
    }

    #[inline(always)]
    fn composite<F: Real>(
        gamma: F,
        front: Accumulated<F>,
        light: Light<F>,
        sample: &Sample<F>,
    ) -> Accumulated<F> {
        let importance = sample.importance.mean;
        let beta = Self::kept(gamma, front.importance, importance);
        front.then(beta, light, front.importance.most(importance))
    }

    // Parts do not change the rise here.
    #[inline(always)]
    fn parts_of_rise<F: Real>(_: &Casting<F>, _: Accumulated<F>, _: &Sample<F>) -> F {
        F::ONE
    }
}
