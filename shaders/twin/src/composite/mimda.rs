//! Maximum Importance Difference Accumulation (LFD eq. 3): what its forms share.

use super::{Accumulated, Composite, Light, Sample};
use crate::tables::TablePlace;
use crate::{Casting, Real};
use std::marker::PhantomData;

/// Accumulation in one of its forms.
pub struct Mimda<M>(PhantomData<M>);

/// A form of the equation. Twins of `wgsl/composite/mimda_*.wgsl`.
pub trait Form {
    /// Whether the parts of a step are composited among themselves first.
    const ONCE_PER_STEP: bool;

    /// β: what a rise of the largest importance from `largest` to `importance` keeps of what lies before it.
    fn kept<F: Real>(gamma: F, largest: F, importance: F) -> F;

    /// A segment's light, behind what is in front.
    fn composite<F: Real>(
        gamma: F,
        front: Accumulated<F>,
        light: Light<F>,
        sample: &Sample<F>,
    ) -> Accumulated<F>;

    /// Parts of each step of a pair, by what a rise of importance within reach may have erased unseen.
    fn parts_of_rise<F: Real>(casting: &Casting<F>, front: Accumulated<F>, reach: &Sample<F>) -> F;
}

impl<M: Form> Composite for Mimda<M> {
    const IS_OVER: bool = false;
    const READS_IMPORTANCE: bool = true;
    const ONCE_PER_STEP: bool = M::ONCE_PER_STEP;

    #[inline(always)]
    fn sample_of<F: Real>(casting: &Casting<F>, k: [F; 4], places: [&TablePlace<F>; 2]) -> Sample<F> {
        Sample::told(casting, k, places)
    }

    /// Importance acts whatever the extinction: no segment is clear.
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
        M::composite(casting.scene.gamma, front, light, sample)
    }

    #[inline(always)]
    fn parts_of_rise<F: Real>(casting: &Casting<F>, front: Accumulated<F>, reach: &Sample<F>) -> F {
        M::parts_of_rise(casting, front, reach)
    }

    /// When the largest importance is yet to come.
    #[inline(always)]
    fn still_to_come<F: Real>(casting: &Casting<F>, front: Accumulated<F>) -> F {
        let scene = casting.scene;
        F::ONE - M::kept(scene.gamma, front.importance, scene.largest_importance) * front.alpha
    }
}
