//! What a segment shows.

use crate::importance::{Importance, importance_between};
use crate::tables::TablePlace;
use crate::{Casting, Real, real::Number};

/// What a segment shows, of one ray or of eight side by side.
#[derive(Clone, Copy, Debug)]
pub struct Sample<F> {
    /// Mean (τ c, τ).
    pub k: [F; 4],
    /// Share of the shading that acts on it.
    pub lit: F,
    /// Factor of the light that it emits.
    pub brightness: F,
    /// Its importance; [`Importance::equal`] in ordinary compositing.
    pub importance: Importance<F>,
}

impl<F: Number> Sample<F> {
    /// Mean (τ c, τ) with its brightness, as no light falls on it.
    #[inline(always)]
    pub fn emitted(&self) -> [F; 4] {
        let [r, g, b, extinction] = self.k;
        [r * self.brightness, g * self.brightness, b * self.brightness, extinction]
    }

    /// Of a mean (τ c, τ), where nothing looks at importance.
    #[inline(always)]
    pub fn plain(k: [F; 4]) -> Self {
        let one = k[0].alike(1.0);
        Self { k, lit: one, brightness: one, importance: Importance::equal(one) }
    }
}

impl<F: Real> Sample<F> {
    /// Of a mean (τ c, τ) between the places of two scalars.
    #[inline(always)]
    pub(super) fn told(casting: &Casting<F>, k: [F; 4], [a, b]: [&TablePlace<F>; 2]) -> Self {
        Self { importance: importance_between(casting.tables, a, b), ..Self::plain(k) }
    }
}
