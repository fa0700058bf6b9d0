//! Maximum Importance Difference Accumulation in the form that telescopes: β = (1 − γ ι) / (1 − γ ι_max).

use super::mimda::Form;
use super::{Accumulated, Light, Sample};
use crate::importance::{MOST_PARTS, RISE};
use crate::{Casting, Real};

/// Twin of `wgsl/composite/mimda_consistent.wgsl`.
pub struct Consistent;

impl Form for Consistent {
    // The product of the parts' β telescopes as they are.
    const ONCE_PER_STEP: bool = false;

    #[inline(always)]
    fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F {
        let before = F::ONE - gamma * largest;
        if importance <= largest || before <= F::ZERO {
            return F::ONE;
        }
        (F::ONE - gamma * importance) / before
    }

    #[inline(always)]
    fn composite<F: Real>(
        gamma: F,
        front: Accumulated<F>,
        light: Light<F>,
        sample: &Sample<F>,
    ) -> Accumulated<F> {
        // The rise up to the segment's mean importance lies before its light, the rest of the rise after it.
        let middle = front.importance.most(sample.importance.mean);
        let end = middle.most(sample.importance.most);
        let beta = Self::kept(gamma, front.importance, middle);
        let rest = Self::kept(gamma, middle, end);
        let all = front.then(beta, light, end);
        Accumulated { rgb: all.rgb * rest, alpha: all.alpha * rest, importance: end }
    }

    // The error falls with the parts, not with their square.
    #[inline(always)]
    fn parts_of_rise<F: Real>(casting: &Casting<F>, front: Accumulated<F>, reach: &Sample<F>) -> F {
        let scene = casting.scene;
        let beyond = Self::kept(scene.gamma, front.importance, reach.importance.most);
        let unseen = (F::ONE - beyond) * front.alpha * (F::of(RISE) / scene.tolerance);
        unseen.ceil().most(F::ONE).least(F::of(MOST_PARTS))
    }
}

#[cfg(test)]
mod tests {
    use super::{Consistent, Form};

    fn kept(gamma: f64, largest: f64, importance: f64) -> f64 {
        Consistent::kept(gamma, largest, importance)
    }

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
