//! What both forms of Maximum Importance Difference Accumulation share.

use super::Sample;
use crate::twin::importance::importance_between;
use crate::twin::tables::{Located, optics_between};
use crate::twin::{Casting, Real};

/// What a segment between two scalars shows.
#[inline(always)]
pub(super) fn sample_between<F: Real>(
    casting: &Casting<F>,
    [a, b]: [&Located<F>; 2],
    (s0, s1): (F, F),
) -> Sample<F> {
    Sample {
        k: optics_between(&casting.tables.optics, a, b),
        lit: F::ONE,
        brightness: F::ONE,
        importance: importance_between(&casting.tables.importance, &casting.tables.importance_most, s0, s1),
    }
}
