//! Averages of the importance over a segment.

use super::{Real, tables::span};
use layout::ImportanceEntry;

/// A step is split into this many parts at most.
pub const MOST_PARTS: f64 = 16.0;

#[inline(always)]
fn importance_at<F: Real>(table: &[ImportanceEntry], u: F, cell: usize) -> F {
    let (a, b) = (F::of_f32(table[cell].value), F::of_f32(table[cell + 1].value));
    a + (b - a) * (u - F::of_u32(cell as u32))
}

/// Parts of a step, times the error allowed per step, where all that lies in front may be erased within reach of it.
pub const RISE: f64 = 0.0064;

/// The importance of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Importance<F> {
    /// Its mean.
    pub mean: F,
    /// The largest.
    pub most: F,
}

impl<F: Real> Importance<F> {
    /// Where all is equally important.
    pub const EQUAL: Self = Self { mean: F::ONE, most: F::ONE };
}

/// ι over scalars [s0, s1]; `most` as in [`crate::tables::Tables`].
#[inline(always)]
pub fn importance_between<F: Real>(table: &[ImportanceEntry], most: &[f32], s0: F, s1: F) -> Importance<F> {
    let (u0, u1, c0, c1) = span(table.len(), s0, s1);
    let half = F::of(0.5);
    let (first, last) = (importance_at(table, u0, c0), importance_at(table, u1, c1));
    let at_ends = first.most(last);
    if c0 == c1 {
        return Importance { mean: half * (first + last), most: at_ends };
    }
    // The nodes between are covered by two spans of a power of two.
    let row = (c1 - c0).ilog2() as usize;
    let start = row * table.len();
    let inside = most[start + c0 + 1].max(most[start + c1 + 1 - (1 << row)]);
    let (after, before) = (&table[c0 + 1], &table[c1]);
    let left = (first + F::of_f32(after.value)) * (half * (F::of_u32(c0 as u32 + 1) - u0));
    let right = (F::of_f32(before.value) + last) * (half * (u1 - F::of_u32(c1 as u32)));
    let whole = (F::of_f32(before.integral) - F::of_f32(after.integral))
        + (F::of_f32(before.integral_rest) - F::of_f32(after.integral_rest));
    // The mean is a rounded quotient.
    let most = at_ends.most(F::of_f32(inside));
    Importance { mean: ((left + whole + right) / (u1 - u0)).least(most), most }
}
