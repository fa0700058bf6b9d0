//! Ordinary front-to-back compositing.

use super::{Accumulated, Composite, Light};
use crate::twin::{Real, Scene};

/// Twin of `wgsl/composite/over.wgsl`.
pub struct Over;

impl Composite for Over {
    const ONCE_PER_STEP: bool = false;

    #[inline(always)]
    fn is_clear<F: Real>(extinction: F) -> bool {
        extinction <= F::ZERO
    }

    #[inline(always)]
    fn composite<F: Real>(_: &Scene<F>, front: Accumulated<F>, light: Light<F>, _: (F, F)) -> Accumulated<F> {
        let through = F::ONE - front.alpha;
        Accumulated {
            rgb: front.rgb + light.rgb * through,
            alpha: front.alpha + light.alpha * through,
            importance: F::ZERO,
        }
    }

    #[inline(always)]
    fn parts_of_rise<F: Real>(_: &Scene<F>, _: Accumulated<F>, _: (F, F)) -> F {
        F::ONE
    }

    #[inline(always)]
    fn still_to_come<F: Real>(_: &Scene<F>, front: Accumulated<F>) -> F {
        F::ONE - front.alpha
    }
}
