//! Averages of the importance over a segment.

use super::{Real, real::Number, tables::TablePlace};
use layout::ImportanceEntry;
use needs::tables::Tables;

/// A step is split into this many parts at most.
pub const MOST_PARTS: f64 = 16.0;

#[inline(always)]
fn importance_at<F: Real>(table: &[ImportanceEntry], place: &TablePlace<F>) -> F {
    let (a, b) = (F::of_f32(table[place.node].value), F::of_f32(table[place.node + 1].value));
    a + (b - a) * place.part
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

impl<F: Number> Importance<F> {
    /// Where all is equally important, as it is to a number.
    #[inline(always)]
    pub fn equal(number: F) -> Self {
        let one = number.alike(1.0);
        Self { mean: one, most: one }
    }
}

/// ι over the scalars between two places.
#[inline(always)]
pub fn importance_between<F: Real>(tables: &Tables, a: &TablePlace<F>, b: &TablePlace<F>) -> Importance<F> {
    let table = &tables.importance;
    let half = F::of(0.5);
    let (a, b) = if b.node < a.node { (b, a) } else { (a, b) };
    let (first, last) = (importance_at(table, a), importance_at(table, b));
    let at_ends = first.most(last);
    if a.node == b.node {
        return Importance { mean: half * (first + last), most: at_ends };
    }
    // The nodes between are covered by two spans of a power of two.
    let row = (b.node - a.node).ilog2() as usize;
    let most = &tables.importance_most[row * table.len()..];
    let inside = most[a.node + 1].max(most[b.node + 1 - (1 << row)]);
    let (after, before) = (&table[a.node + 1], &table[b.node]);
    let position = |node: usize| F::of_f32(tables.optics[node].position);
    let left = (first + F::of_f32(after.value)) * (half * (position(a.node + 1) - a.u));
    let right = (F::of_f32(before.value) + last) * (half * (b.u - position(b.node)));
    let whole = (F::of_f32(before.integral) - F::of_f32(after.integral))
        + (F::of_f32(before.integral_rest) - F::of_f32(after.integral_rest));
    // The mean is a rounded quotient.
    let most = at_ends.most(F::of_f32(inside));
    Importance { mean: ((left + whole + right) / (b.u - a.u)).least(most), most }
}
