//! The range of what some samples hold: whether anything shows of it, and whether the fine table tells all of that.

use crate::fine::CLOSE;
use crate::near::Samples;
use crate::steep::Steep;
use lanes::*;
use twin::tables::is_vacant_around;

/// The bound of the fine table's error is this many times what it comes to: few scalars lie beside a kink.
const FINE_ENOUGH: f32 = 10.0;

/// A range of scalars, and how far around each other scalars are met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub(crate) low: f32,
    pub(crate) high: f32,
    pub(crate) spread: f32,
}

impl Around {
    pub(crate) const ALL: Self = Self { low: 0.0, high: 1.0, spread: 0.0 };

    /// Of eight rays between two depths. Where nothing is known at one of them, nothing shows between. None if that is so for all.
    #[inline(always)]
    pub(crate) fn between<S: Simd>(simd: S, [front, back]: [f32x8<S>; 2], spread: f32x8<S>) -> Option<Self> {
        let sum = front + back;
        let is_known = sum.simd_eq(sum);
        let low = is_known.select(front.min(back), splat(simd, f32::MAX));
        let high = is_known.select(front.max(back), splat(simd, f32::MIN));
        Self::of(least(low), greatest(simd, high), largest(spread))
    }

    /// Of eight rays at some depths; of whatever is known. None if nothing is.
    #[inline(always)]
    pub(crate) fn all<S: Simd, const COUNT: usize>(simd: S, samples: [&Samples<S>; COUNT]) -> Option<Self> {
        let (mut low, mut high) = (splat(simd, f32::MAX), splat(simd, f32::MIN));
        let mut widest = splat(simd, 0.0);
        for Samples { scalars, spreads, known } in samples {
            low = known.select(low.min(*scalars), low);
            high = known.select(high.max(*scalars), high);
            widest = widest.max(*spreads);
        }
        Self::of(least(low), greatest(simd, high), largest(widest))
    }

    #[inline(always)]
    fn of(low: f32, high: f32, spread: f32) -> Option<Self> {
        (low <= high).then_some(Self { low, high, spread })
    }

    /// The lowest and the highest scalar that is met.
    #[inline(always)]
    pub(crate) fn reach(&self) -> (f32, f32) {
        ((self.low - self.spread).max(0.0), (self.high + self.spread).min(1.0))
    }
}

impl Steep<'_> {
    /// Whether nothing shows.
    #[inline(always)]
    pub(crate) fn is_vacant(&self, around: &Around) -> bool {
        is_vacant_around(&self.casting.tables.cells, (around.low, around.high), around.spread)
    }

    /// Whether the fine table tells all that shows, where a cell has `thickness`.
    #[inline(always)]
    pub(crate) fn is_fine(&self, around: &Around, thickness: f32) -> bool {
        let (low, high) = around.reach();
        let error = self.roughness.bend(low, high, CLOSE).max(self.fine.rounding);
        error * thickness <= FINE_ENOUGH * self.tolerance
    }
}
