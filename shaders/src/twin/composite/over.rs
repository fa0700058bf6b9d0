//! Ordinary front-to-back compositing.

use super::{Accumulated, Composite, Light, Sample};
use crate::twin::{Casting, Real};

/// Twin of `wgsl/composite/over.wgsl`.
pub struct Over;

/// The same of samples whose importance enhancers look at.
pub struct Told;

/// Ordinary compositing; whether samples have importance, and how they come by it.
macro_rules! over {
    ($name:ident, $reads:literal, |$casting:ident, $k:ident, $scalars:ident| $sample:expr) => {
        impl Composite for $name {
            const READS_IMPORTANCE: bool = $reads;
            const ONCE_PER_STEP: bool = false;

            #[inline(always)]
            fn sample_of<F: Real>($casting: &Casting<F>, $k: [F; 4], $scalars: (F, F)) -> Sample<F> {
                $sample
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
    };
}
over!(Over, false, |_casting, k, _scalars| Sample::plain(k));
over!(Told, true, |casting, k, scalars| Sample::told(casting, k, scalars));
