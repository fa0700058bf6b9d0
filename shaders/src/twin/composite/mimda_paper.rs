//! Maximum Importance Difference Accumulation as published (LFD eq. 3): β = 1 − γ max(ι − ι_max, 0).

use super::{Accumulated, Composite};
use crate::twin::{Real, Scene, importance::importance_between, vector::Vec3};

/// Twin of `wgsl/composite/mimda_paper.wgsl`.
pub struct MimdaPaper;

/// β: what a rise of the largest importance keeps of what lies before it.
#[inline(always)]
fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F {
    F::ONE - gamma * (importance - largest).most(F::ZERO)
}

impl Composite for MimdaPaper {
    #[inline(always)]
    fn is_clear<F: Real>(_: F) -> bool {
        false
    }

    #[inline(always)]
    fn composite<F: Real>(
        scene: &Scene<F>,
        front: Accumulated<F>,
        rgb: Vec3<F>,
        alpha: F,
        s0: F,
        s1: F,
    ) -> Accumulated<F> {
        let importance = importance_between(scene.importance, s0, s1).mean;
        let beta = kept(scene.view.gamma, front.importance, importance);
        front.then(beta, rgb, alpha, front.importance.most(importance))
    }

    #[inline(always)]
    fn still_to_come<F: Real>(scene: &Scene<F>, front: Accumulated<F>) -> F {
        F::ONE - kept(scene.view.gamma, front.importance, scene.view.largest_importance) * front.alpha
    }
}
