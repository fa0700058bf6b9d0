//! A segment whose scalars stand for those within a standard deviation of them.

use crate::composite::{Composite, Sample};
use crate::four::each;
use crate::tables::{Located, locate, optics_between};
use crate::{Casting, Real};
use needs::tables::Tables;

/// What a segment between two scalars shows, each of which stands for those within `spread` of it.
#[inline(always)]
pub fn sample_over<F: Real, C: Composite>(
    casting: &Casting<F>,
    [a, b]: [&Located<F>; 2],
    scalars: (F, F),
    spread: F,
) -> Sample<F> {
    let tables = casting.tables;
    let k =
        if spread > F::ZERO { optics_over(tables, scalars, spread) } else { optics_between(tables, a, b) };
    C::sample_of(casting, k, [&a.place, &b.place])
}

/// Mean of (τ c, τ) over the scalars within `reach` of `middle`; beyond [0, 1] they are what they are at its ends.
#[inline(always)]
fn optics_around<F: Real>(tables: &Tables, middle: F, reach: F) -> [F; 4] {
    let (from, to) = (middle - reach, middle + reach);
    let (low, high) = (locate(tables, from.most(F::ZERO)), locate(tables, to.least(F::ONE)));
    let inside = optics_between(tables, &low, &high);
    let outside = ((-from).most(F::ZERO), (to - F::ONE).most(F::ZERO));
    with_outside(inside, [&low, &high], outside, F::of(2.0) * reach)
}

/// The mean over a width of which `below` lies below 0 and `above` above 1, given that of what lies inside.
#[inline(always)]
pub(crate) fn with_outside<F: Real>(
    inside: [F; 4],
    [low, high]: [&Located<F>; 2],
    (below, above): (F, F),
    width: F,
) -> [F; 4] {
    if below + above == F::ZERO {
        return inside;
    }
    each!(C => {
        let outside = low.value[C] * below + high.value[C] * above;
        (inside[C] * (width - below - above) + outside) / width
    })
}

/// Mean of (τ c, τ) over a segment between two scalars, each of which stands for those within `spread` of it; see the WGSL.
#[inline(always)]
fn optics_over<F: Real>(tables: &Tables, (s0, s1): (F, F), spread: F) -> [F; 4] {
    let half = F::of(0.5);
    let along = half * (s1 - s0);
    optics_around(tables, half * (s0 + s1), (along * along + spread * spread).sqrt())
}
