//! Averages of the importance over a segment.

use super::{Real, tables::span};
use crate::layout::ImportanceEntry;

#[inline(always)]
fn importance_at<F: Real>(table: &[ImportanceEntry], u: F, cell: usize) -> F {
    let (a, b) = (F::of_f32(table[cell].value), F::of_f32(table[cell + 1].value));
    a + (b - a) * (u - F::of_u32(cell as u32))
}

/// Parts of a step where all that lies in front may be erased within reach of it.
pub const RISE: f64 = 64.0;

/// The importance of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Importance<F> {
    /// Its mean.
    pub mean: F,
    /// At its two ends, in the order of the ray.
    pub ends: [F; 2],
}

impl<F: Real> Importance<F> {
    /// Where all is equally important.
    pub const EQUAL: Self = Self { mean: F::ONE, ends: [F::ONE; 2] };

    /// The larger of the values at the two ends.
    #[inline(always)]
    pub fn at_ends(&self) -> F {
        self.ends[0].most(self.ends[1])
    }
}

/// ι over scalars [s0, s1].
#[inline(always)]
pub fn importance_between<F: Real>(table: &[ImportanceEntry], s0: F, s1: F) -> Importance<F> {
    let (u0, u1, c0, c1) = span(table.len(), s0, s1);
    let half = F::of(0.5);
    let (first, last) = (importance_at(table, u0, c0), importance_at(table, u1, c1));
    let ends = if s1 < s0 { [last, first] } else { [first, last] };
    if c0 == c1 {
        return Importance { mean: half * (first + last), ends };
    }
    let (after, before) = (&table[c0 + 1], &table[c1]);
    let left = (first + F::of_f32(after.value)) * (half * (F::of_u32(c0 as u32 + 1) - u0));
    let right = (F::of_f32(before.value) + last) * (half * (u1 - F::of_u32(c1 as u32)));
    let whole = (F::of_f32(before.integral) - F::of_f32(after.integral))
        + (F::of_f32(before.integral_rest) - F::of_f32(after.integral_rest));
    Importance { mean: (left + whole + right) / (u1 - u0), ends }
}
