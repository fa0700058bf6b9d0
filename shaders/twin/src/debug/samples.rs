//! The debug view of samples: how many a ray took, instead of its colour.

use super::heat;
use crate::Real;
use optics::DebugView;

/// The colour of a ray.
pub(super) fn pixel<F: Real>(samples: u32) -> [F; 4] {
    let (_, most) = DebugView::Samples.scale();
    let count = F::ONE + F::of_u32(samples);
    let [r, g, b] = heat((count.log2() / F::of(1.0 + most).log2()).least(F::ONE)).0;
    [r, g, b, F::ONE]
}
