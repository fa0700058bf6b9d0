//! Maximum Importance Difference Accumulation as published (LFD eq. 3): β = 1 − γ max(ι − ι_max, 0).

use super::{Accumulated, Composite, Light, Sample, mimda};
use crate::twin::tables::Located;
use crate::twin::{Casting, Real};

/// Twin of `wgsl/composite/mimda_paper.wgsl`.
pub struct MimdaPaper;

/// β: what a rise of the largest importance keeps of what lies before it.
#[inline(always)]
fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F {
    F::ONE - gamma * (importance - largest).most(F::ZERO)
}

impl Composite for MimdaPaper {
    const READS_IMPORTANCE: bool = true;
    const ONCE_PER_STEP: bool = true;

    #[inline(always)]
    fn sample_between<F: Real>(
        casting: &Casting<F>,
        located: [&Located<F>; 2],
        scalars: (F, F),
    ) -> Sample<F> {
        mimda::sample_between(casting, located, scalars)
    }

    #[inline(always)]
    fn is_clear<F: Real>(_: F) -> bool {
        false
    }

    #[inline(always)]
    fn composite<F: Real>(
        casting: &Casting<F>,
        front: Accumulated<F>,
        light: Light<F>,
        sample: &Sample<F>,
    ) -> Accumulated<F> {
        let importance = sample.importance.mean;
        let beta = kept(casting.scene.gamma, front.importance, importance);
        front.then(beta, light, front.importance.most(importance))
    }

    #[inline(always)]
    fn parts_of_rise<F: Real>(_: &Casting<F>, _: Accumulated<F>, _: &Sample<F>) -> F {
        F::ONE
    }

    #[inline(always)]
    fn still_to_come<F: Real>(casting: &Casting<F>, front: Accumulated<F>) -> F {
        F::ONE - kept(casting.scene.gamma, front.importance, casting.scene.largest_importance) * front.alpha
    }
}
