//! Maximum Importance Difference Accumulation in the form that telescopes: β = (1 − γ ι) / (1 − γ ι_max).

use super::{Accumulated, Composite, Light, Sample, mimda};
use crate::twin::tables::Located;
use crate::twin::{Casting, Real, importance::RISE, refine::MOST_PARTS};

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
    const READS_IMPORTANCE: bool = true;
    const ONCE_PER_STEP: bool = false;

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
        // The rise up to the segment's mean importance lies before its light, the rest of the rise after it.
        let middle = front.importance.most(sample.importance.mean);
        let end = middle.most(sample.importance.most);
        let beta = kept(casting.scene.gamma, front.importance, middle);
        let rest = kept(casting.scene.gamma, middle, end);
        let all = front.then(beta, light, end);
        Accumulated { rgb: all.rgb * rest, alpha: all.alpha * rest, importance: end }
    }

    #[inline(always)]
    fn parts_of_rise<F: Real>(casting: &Casting<F>, front: Accumulated<F>, reach: &Sample<F>) -> F {
        let beyond = kept(casting.scene.gamma, front.importance, reach.importance.most);
        let unseen = (F::ONE - beyond) * front.alpha * (F::of(RISE) / casting.scene.tolerance);
        unseen.ceil().most(F::ONE).least(F::of(MOST_PARTS))
    }

    #[inline(always)]
    fn still_to_come<F: Real>(casting: &Casting<F>, front: Accumulated<F>) -> F {
        F::ONE - kept(casting.scene.gamma, front.importance, casting.scene.largest_importance) * front.alpha
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
