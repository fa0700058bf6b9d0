//! Ordinary front-to-back compositing.

use super::{Accumulated, Composite};
use crate::twin::{Real, Scene, vector::Vec3};

/// Twin of `wgsl/composite/over.wgsl`.
pub struct Over;

impl Composite for Over {
    #[inline(always)]
    fn is_clear<F: Real>(extinction: F) -> bool {
        extinction <= F::ZERO
    }

    #[inline(always)]
    fn composite<F: Real>(
        _: &Scene<F>,
        front: Accumulated<F>,
        rgb: Vec3<F>,
        alpha: F,
        _: F,
        _: F,
    ) -> Accumulated<F> {
        let through = F::ONE - front.alpha;
        Accumulated {
            rgb: front.rgb + rgb * through,
            alpha: front.alpha + alpha * through,
            importance: F::ZERO,
        }
    }

    #[inline(always)]
    fn still_to_come<F: Real>(_: &Scene<F>, front: Accumulated<F>) -> F {
        F::ONE - front.alpha
    }
}
