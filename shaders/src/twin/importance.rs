//! Averages of the importance over a segment.

use super::{Real, tables::span};
use crate::layout::ImportanceEntry;

#[inline(always)]
fn importance_at<F: Real>(table: &[ImportanceEntry], u: F, cell: usize) -> F {
    let (a, b) = (F::of_f32(table[cell].value), F::of_f32(table[cell + 1].value));
    a + (b - a) * (u - F::of_u32(cell as u32))
}

/// Mean of ι over scalars [s0, s1].
#[inline(always)]
pub fn importance_between<F: Real>(table: &[ImportanceEntry], s0: F, s1: F) -> F {
    let (u0, u1, c0, c1) = span(table.len(), s0, s1);
    let half = F::of(0.5);
    if c0 == c1 {
        return importance_at(table, half * (u0 + u1), c0);
    }
    let (after, before) = (&table[c0 + 1], &table[c1]);
    let left =
        (importance_at(table, u0, c0) + F::of_f32(after.value)) * (half * (F::of_u32(c0 as u32 + 1) - u0));
    let right =
        (F::of_f32(before.value) + importance_at(table, u1, c1)) * (half * (u1 - F::of_u32(c1 as u32)));
    let whole = (F::of_f32(before.integral) - F::of_f32(after.integral))
        + (F::of_f32(before.integral_rest) - F::of_f32(after.integral_rest));
    (left + whole + right) / (u1 - u0)
}
