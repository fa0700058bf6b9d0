//! Maximum Importance Difference Accumulation in the form that telescopes: β = (1 − γ ι) / (1 − γ ι_max).

use super::{Accumulated, Composite};
use crate::twin::{Real, Scene, importance::importance_between, vector::Vec3};

/// Twin of `wgsl/composite/mimda_consistent.wgsl`.
pub struct MimdaConsistent;

/// β: what a rise of the largest importance keeps of what lies before it.
#[inline(always)]
fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F {
    let before = F::ONE - gamma * largest;
    if importance <= largest || before <= F::ZERO {
        return F::ONE;
    }
    (F::ONE - gamma * importance) / before
}

impl Composite for MimdaConsistent {
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
        let importance = importance_between(scene.importance, s0, s1);
        // The rise up to the segment's mean importance lies before its light, the rest of the rise after it.
        let middle = front.importance.most(importance.mean);
        let end = middle.most(importance.at_ends);
        let beta = kept(scene.view.gamma, front.importance, middle);
        let rest = kept(scene.view.gamma, middle, end);
        let all = front.then(beta, rgb, alpha, end);
        Accumulated { rgb: all.rgb * rest, alpha: all.alpha * rest, importance: end }
    }

    #[inline(always)]
    fn still_to_come<F: Real>(scene: &Scene<F>, front: Accumulated<F>) -> F {
        F::ONE - kept(scene.view.gamma, front.importance, scene.view.largest_importance) * front.alpha
    }
}

#[cfg(test)]
mod tests {
    use super::kept;

    #[test]
    fn rises_telescope_whatever_the_steps() {
        for steps in [1, 2, 7, 1000] {
            let product = (0..steps).fold(1.0, |kept_so_far, i| {
                let at = |i: i32| 0.8 * f64::from(i) / f64::from(steps);
                kept_so_far * kept(0.9, at(i), at(i + 1))
            });
            assert!((product - (1.0 - 0.9 * 0.8)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_full_rise_hides_all_and_nothing_follows() {
        assert_eq!(kept(1.0, 0.0, 1.0), 0.0);
        assert_eq!(kept(1.0, 1.0, 1.0), 1.0);
    }
}
