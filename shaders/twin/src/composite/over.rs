//! Ordinary front-to-back compositing.

use super::{Accumulated, Composite, Light, Sample};
use crate::tables::TablePlace;
use crate::{Casting, Real};

/// Twin of `wgsl/composite/over.wgsl`; `IS_TOLD` says whether samples have importance, which enhancers look at.
pub struct Over<const IS_TOLD: bool>;

impl<const IS_TOLD: bool> Composite for Over<IS_TOLD> {
    const IS_OVER: bool = true;
    const READS_IMPORTANCE: bool = IS_TOLD;
    const ONCE_PER_STEP: bool = false;

    #[inline(always)]
    fn sample_of<F: Real>(casting: &Casting<F>, k: [F; 4], places: [&TablePlace<F>; 2]) -> Sample<F> {
        if IS_TOLD { Sample::told(casting, k, places) } else { Sample::plain(k) }
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
        front.over(light)
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
