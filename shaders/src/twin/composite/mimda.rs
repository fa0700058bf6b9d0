//! What both forms of Maximum Importance Difference Accumulation share.

use super::Sample;
use crate::twin::importance::importance_between;
use crate::twin::tables::{Located, optics_between};
use crate::twin::{Real, Scene};

/// What a segment between two scalars shows.
#[inline(always)]
pub(super) fn sample_between<F: Real>(
    scene: &Scene<F>,
    [a, b]: [&Located<F>; 2],
    (s0, s1): (F, F),
) -> Sample<F> {
    Sample {
        k: optics_between(&scene.tables.optics, a, b),
        lit: F::ONE,
        importance: importance_between(&scene.tables.importance, s0, s1),
    }
}
