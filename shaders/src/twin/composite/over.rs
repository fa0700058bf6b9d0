//! Ordinary front-to-back compositing.

use super::{Accumulated, Composite, Light, Sample};
use crate::twin::importance::Importance;
use crate::twin::tables::TablePlace;
use crate::twin::{Casting, Real};

/// Twin of `wgsl/composite/over.wgsl`.
pub struct Over;

impl Composite for Over {
    const READS_IMPORTANCE: bool = false;
    const ONCE_PER_STEP: bool = false;

    #[inline(always)]
    fn sample_of<F: Real>(_: &Casting<F>, k: [F; 4], _: [&TablePlace<F>; 2]) -> Sample<F> {
        Sample { k, lit: F::ONE, brightness: F::ONE, importance: Importance::EQUAL }
    }

    #[inline(always)]
    fn is_clear<F: Real>(extinction: F) -> bool {
        extinction <= F::ZERO
    }

    #[inline(always)]
    fn composite<F: Real>(
        _: &Casting<F>,
        front: Accumulated<F>,
        light: Light<F>,
        _: &Sample<F>,
    ) -> Accumulated<F> {
        let through = F::ONE - front.alpha;
        Accumulated {
            rgb: front.rgb + light.rgb * through,
            alpha: front.alpha + light.alpha * through,
            importance: F::ZERO,
        }
    }

    #[inline(always)]
    fn parts_of_rise<F: Real>(_: &Casting<F>, _: Accumulated<F>, _: &Sample<F>) -> F {
        F::ONE
    }

    #[inline(always)]
    fn still_to_come<F: Real>(_: &Casting<F>, front: Accumulated<F>) -> F {
        F::ONE - front.alpha
    }
}
