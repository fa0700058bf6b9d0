//! Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

use super::Real;
use super::four::{each, mix, widen};
use layout::OpticsEntry;

/// A scalar's place in a table, and the values there: looked up once, used for every mean that ends at it.
#[derive(Clone, Copy, Debug)]
pub struct Located<F> {
    /// Position in cells.
    u: F,
    /// The cell it lies in.
    cell: usize,
    /// (τ c, τ).
    pub(super) value: [F; 4],
}

/// Looks up a scalar in [0, 1].
#[inline(always)]
pub fn locate<F: Real>(table: &[OpticsEntry], s: F) -> Located<F> {
    let u = s * F::of_u32(table.len() as u32 - 1);
    let cell = (u.to_index() as usize).min(table.len() - 2);
    let f = u - F::of_u32(cell as u32);
    let ends = &table[cell..cell + 2];
    Located { u, cell, value: mix(widen(&ends[0].value), widen(&ends[1].value), f) }
}

/// The part of a table that two scalars span: positions in cells, smaller first, and the cells they lie in.
#[inline(always)]
pub(super) fn span<F: Real>(entries: usize, s0: F, s1: F) -> (F, F, usize, usize) {
    let cells = F::of_u32(entries as u32 - 1);
    let (u0, u1) = (s0.least(s1) * cells, s0.most(s1) * cells);
    let last = entries - 2;
    (u0, u1, (u0.to_index() as usize).min(last), (u1.to_index() as usize).min(last))
}

/// Mean of (τ c, τ) between two scalars; see the WGSL for why nothing cancels.
#[inline(always)]
pub fn optics_between<F: Real>(table: &[OpticsEntry], a: &Located<F>, b: &Located<F>) -> [F; 4] {
    let half = F::of(0.5);
    if a.cell == b.cell {
        return each!(C => half * (a.value[C] + b.value[C]));
    }
    let (first, last) = if a.cell < b.cell { (a, b) } else { (b, a) };
    let (after, before) = (&table[first.cell + 1], &table[last.cell]);
    let left = half * (F::of_u32(first.cell as u32 + 1) - first.u);
    let right = half * (last.u - F::of_u32(last.cell as u32));
    let width = last.u - first.u;
    let per_width = F::ONE / width;
    each!(C => {
        let whole = (F::of_f32(before.integral[C]) - F::of_f32(after.integral[C]))
            + (F::of_f32(before.integral_rest[C]) - F::of_f32(after.integral_rest[C]));
        let ends = (first.value[C] + F::of_f32(after.value[C])) * left;
        (ends + whole + (F::of_f32(before.value[C]) + last.value[C]) * right) * per_width
    })
}

/// Whether nothing within scalars [low, high] changes a picture; `occupied` as [`crate::tables::occupancy`] counts.
#[inline(always)]
fn is_vacant<F: Real>(occupied: &[u32], low: F, high: F) -> bool {
    let (_, _, c0, c1) = span(occupied.len(), low, high);
    occupied[c0] == occupied[c1 + 1]
}

/// Whether nothing within `spread` of scalars [low, high] changes a picture.
#[inline(always)]
pub fn is_vacant_around<F: Real>(occupied: &[u32], (low, high): (F, F), spread: F) -> bool {
    is_vacant(occupied, (low - spread).most(F::ZERO), (high + spread).least(F::ONE))
}

/// φ(x) = (1 − e^−x) / x; a series where the difference would cancel.
#[inline(always)]
pub fn attenuation_mean<F: Real>(x: F) -> F {
    if x < F::of(0.25) {
        let c = |n: f64| F::of(1.0 / n);
        return F::ONE - x * (c(2.0) - x * (c(6.0) - x * (c(24.0) - x * (c(120.0) - x * c(720.0)))));
    }
    (F::ONE - (-x).exp()) / x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::optics_table;
    use optics::{Curve, Optics};
    use proptest::prelude::*;

    /// Six terms of the series, cut off at x = 1/4: the next term is x⁶/5040.
    const SERIES_ERROR: f64 = 0.25 * 0.25 * 0.25 * 0.25 * 0.25 * 0.25 / 5040.0;

    fn mean(table: &[OpticsEntry], s0: f32, s1: f32) -> f32 {
        optics_between(table, &locate(table, s0), &locate(table, s1))[3]
    }

    fn table(points: Vec<(f64, f64)>) -> Vec<OpticsEntry> {
        optics_table(&Optics::grey(Curve::new(points).unwrap()))
    }

    #[test]
    fn attenuation_is_right_from_tiny_to_huge() {
        for exponent in -60..60 {
            let x = 10f64.powf(f64::from(exponent) / 10.0);
            let truth = -(-x).exp_m1() / x;
            assert!((attenuation_mean(x) - truth).abs() <= SERIES_ERROR + 1e-12, "{x}");
            let in_f32 = f64::from(attenuation_mean(x as f32));
            assert!((in_f32 / truth - 1.0).abs() < 1e-6, "{x}: {in_f32} for {truth}");
        }
        assert_eq!(attenuation_mean(0.0f32), 1.0);
        assert_eq!(attenuation_mean(1e30f32), 1e-30);
    }

    /// Two f32 hold an integral to 2⁻⁴⁸ of itself; a difference of two is off by twice that at most.
    const TWO_FLOATS: f64 = 2.0 / (1u64 << 48) as f64;

    #[test]
    fn a_low_range_beside_a_spike_keeps_its_digits() {
        let mut table = table(vec![(0.0, 1e6), (0.1, 1e6), (0.1, 1e-6), (1.0, 1e-6)]);
        let worst = |table: &[OpticsEntry]| {
            [(0.2f32, 0.9f32), (0.5, 0.503), (0.9, 0.8999)].into_iter().fold(0.0f64, |worst, (s0, s1)| {
                let error = (f64::from(mean(table, s0, s1)) - 1e-6).abs();
                let cells = f64::from((s1 - s0).abs()) * (table.len() - 1) as f64;
                let whole = f64::from(table[table.len() - 1].integral[3]);
                worst.max(error / (TWO_FLOATS * whole / cells + 1e-12))
            })
        };
        assert!(worst(&table) <= 1.0, "{}", worst(&table));
        // The canary: one f32 alone does not do.
        table.iter_mut().for_each(|entry| entry.integral_rest = [0.0; 4]);
        assert!(worst(&table) > 100.0, "{}", worst(&table));
    }

    proptest! {
        #[test]
        fn means_lie_within_the_curve_and_are_symmetric(
            values in prop::collection::vec(0.0..10.0f64, 5), s0 in 0.0..=1.0f32, s1 in 0.0..=1.0f32,
        ) {
            let points: Vec<_> = values.iter().enumerate().map(|(i, &v)| (i as f64 / 4.0, v)).collect();
            let most = values.iter().fold(0.0f64, |m, &v| m.max(v)) as f32;
            let table = table(points);
            let found = mean(&table, s0, s1);
            prop_assert!(found >= 0.0 && found <= most * 1.0001 + 1e-6);
            prop_assert_eq!(found, mean(&table, s1, s0));
        }
    }
}
