//! Averages of the transfer functions over a segment, from tables of f and F = ∫ f.

use super::four::{each, mix, widen};
use super::{Real, real::Number};
use layout::{TableCell, TableEntry};
use needs::tables::{TABLE_CELLS, Tables};

/// A scalar's place in the tables.
#[derive(Clone, Copy, Debug)]
pub struct TablePlace<F> {
    /// Position in cells.
    pub(super) u: F,
    /// The node at or below it.
    pub(super) node: usize,
    /// How far it is from there to the next.
    pub(super) part: F,
}

/// A scalar's place, and a table's values there: looked up once, used for every mean that ends at it.
#[derive(Clone, Copy, Debug)]
pub struct Located<F> {
    /// The place.
    pub(super) place: TablePlace<F>,
    /// (τ c, τ), or a material.
    pub(super) value: [F; 4],
}

impl<F: Real> Located<F> {
    /// A table's values there.
    pub fn value(&self) -> [F; 4] {
        self.value
    }
}

/// Position in cells, and the cell.
#[inline(always)]
fn cell_of<F: Real>(s: F) -> (F, usize) {
    let u = s * F::of_u32(TABLE_CELLS as u32);
    (u, (u.to_index() as usize).min(TABLE_CELLS - 1))
}

/// The place of a scalar in [0, 1].
#[inline(always)]
pub(super) fn place_of<F: Real>(tables: &Tables, s: F) -> TablePlace<F> {
    let (u, cell) = cell_of(s);
    place_in(tables, u, cell, u - F::of_u32(cell as u32))
}

/// The place of a scalar in a cell, `part` of it from its lower border.
#[inline(always)]
fn place_in<F: Real>(tables: &Tables, u: F, cell: usize, part: F) -> TablePlace<F> {
    let TableCell { first, inside, .. } = tables.cells[cell];
    let first = first as usize;
    if inside[0] == f32::MAX {
        return TablePlace { u, node: first, part };
    }
    place_among_knots(&tables.optics[first..=tables.cells[cell + 1].first as usize], u, first)
}

/// The same in a cell with knots: among the nodes from its lower border to its upper one, the last at or below u.
#[inline(never)]
fn place_among_knots<F: Real>(nodes: &[TableEntry], u: F, first: usize) -> TablePlace<F> {
    let position = |node: usize| F::of_f32(nodes[node].position);
    let inside = &nodes[1..nodes.len() - 1];
    let low = inside.partition_point(|node| F::of_f32(node.position) <= u);
    let width = position(low + 1) - position(low);
    // The end of the last cell may lie on a jump: it is what it is there.
    let part = if width > F::ZERO { (u - position(low)) / width } else { F::ONE };
    TablePlace { u, node: first + low, part }
}

/// Looks up a scalar in [0, 1].
#[inline(always)]
pub fn locate<F: Real>(tables: &Tables, s: F) -> Located<F> {
    located(tables, place_of(tables, s))
}

#[inline(always)]
fn located<F: Real>(tables: &Tables, place: TablePlace<F>) -> Located<F> {
    Located { place, value: value_at(&tables.optics, &place) }
}

/// Looks up a scalar whose cell is known, `part` of it from its lower border.
#[inline(always)]
pub(super) fn locate_in(tables: &Tables, u: f32, cell: usize, part: f32) -> Located<f32> {
    located(tables, place_in(tables, u, cell, part))
}

/// [`optics_between`], given what the distance of the places divides by where they lie between other nodes.
#[inline(always)]
pub(super) fn optics_between_by(
    tables: &Tables,
    a: &Located<f32>,
    b: &Located<f32>,
    per_width: f32,
) -> [f32; 4] {
    if a.place.node == b.place.node {
        return optics_between(tables, a, b);
    }
    mean_across(&tables.optics, a, b, per_width)
}

#[inline(always)]
fn value_at<F: Real>(table: &[TableEntry], place: &TablePlace<F>) -> [F; 4] {
    let ends = &table[place.node..place.node + 2];
    mix(widen(&ends[0].value), widen(&ends[1].value), place.part)
}

/// Mean of (τ c, τ) between two scalars; see the WGSL for why nothing cancels.
#[inline(always)]
pub fn optics_between<F: Real>(tables: &Tables, a: &Located<F>, b: &Located<F>) -> [F; 4] {
    mean_between(&tables.optics, a, b)
}

/// Looks up the material of a scalar in [0, 1].
#[inline(always)]
pub(super) fn locate_material<F: Real>(tables: &Tables, s: F) -> Located<F> {
    let place = place_of(tables, s);
    Located { place, value: value_at(&tables.materials, &place) }
}

/// Mean of a material's factors between two scalars.
#[inline(always)]
pub(super) fn materials_between<F: Real>(tables: &Tables, a: &Located<F>, b: &Located<F>) -> [F; 4] {
    mean_between(&tables.materials, a, b)
}

#[inline(always)]
fn mean_between<F: Real>(table: &[TableEntry], a: &Located<F>, b: &Located<F>) -> [F; 4] {
    if a.place.node == b.place.node {
        let half = F::of(0.5);
        return each!(C => half * (a.value[C] + b.value[C]));
    }
    mean_across(table, a, b, F::ONE / (b.place.u - a.place.u).abs())
}

/// The same between two nodes, given what the distance of the places divides by.
#[inline(always)]
fn mean_across<F: Real>(table: &[TableEntry], a: &Located<F>, b: &Located<F>, per_width: F) -> [F; 4] {
    let half = F::of(0.5);
    let (first, last) = if a.place.node < b.place.node { (a, b) } else { (b, a) };
    let (after, before) = (&table[first.place.node + 1], &table[last.place.node]);
    let left = half * (F::of_f32(after.position) - first.place.u);
    let right = half * (last.place.u - F::of_f32(before.position));
    each!(C => {
        let whole = (F::of_f32(before.integral[C]) - F::of_f32(after.integral[C]))
            + (F::of_f32(before.integral_rest[C]) - F::of_f32(after.integral_rest[C]));
        let ends = (first.value[C] + F::of_f32(after.value[C])) * left;
        (ends + whole + (F::of_f32(before.value[C]) + last.value[C]) * right) * per_width
    })
}

/// Whether nothing within scalars [low, high] changes a picture.
#[inline(always)]
fn is_vacant<F: Real>(cells: &[TableCell], low: F, high: F) -> bool {
    let [(_, c0), (_, c1)] = [low, high].map(cell_of);
    is_vacant_between(cells, c0, c1)
}

/// Whether nothing from one cell to another changes a picture.
#[inline(always)]
pub(super) fn is_vacant_between(cells: &[TableCell], first: usize, last: usize) -> bool {
    cells[first].occupied == cells[last + 1].occupied
}

/// Whether nothing within `spread` of scalars [low, high] changes a picture.
#[inline(always)]
pub fn is_vacant_around<F: Real>(cells: &[TableCell], (low, high): (F, F), spread: F) -> bool {
    is_vacant(cells, (low - spread).most(F::ZERO), (high + spread).least(F::ONE))
}

/// φ(x) = (1 − e^−x) / x; a series where the difference would cancel.
#[inline(always)]
pub fn attenuation_mean<F: Number>(x: F) -> F {
    let (one, small) = (x.alike(1.0), x.alike(0.25));
    let fourth = x.alike(1.0 / 24.0) - x * (x.alike(1.0 / 120.0) - x * x.alike(1.0 / 720.0));
    let series = one - x * (x.alike(1.0 / 2.0) - x * (x.alike(1.0 / 6.0) - x * fourth));
    if x.is_below(small) {
        return series;
    }
    x.choose(small, series, (one - (-x).exp()) / x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use needs::Needs;
    use optics::{Curve, Optics};
    use proptest::prelude::*;

    /// Six terms of the series, cut off at x = 1/4: the next term is x⁶/5040.
    const SERIES_ERROR: f64 = 0.25 * 0.25 * 0.25 * 0.25 * 0.25 * 0.25 / 5040.0;

    fn mean(tables: &Tables, s0: f32, s1: f32) -> f32 {
        optics_between(tables, &locate(tables, s0), &locate(tables, s1))[3]
    }

    fn tables(points: Vec<(f64, f64)>) -> Tables {
        Tables::new(&Optics::grey(Curve::new(points).unwrap()), &Needs::PLAIN)
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
        let mut tables = tables(vec![(0.0, 1e6), (0.1, 1e6), (0.1, 1e-6), (1.0, 1e-6)]);
        let worst = |tables: &Tables| {
            [(0.2f32, 0.9f32), (0.5, 0.503), (0.9, 0.8999)].into_iter().fold(0.0f64, |worst, (s0, s1)| {
                let error = (f64::from(mean(tables, s0, s1)) - 1e-6).abs();
                let cells = f64::from((s1 - s0).abs()) * TABLE_CELLS as f64;
                let whole = f64::from(tables.optics.last().unwrap().integral[3]);
                worst.max(error / (TWO_FLOATS * whole / cells + 1e-12))
            })
        };
        assert!(worst(&tables) <= 1.0, "{}", worst(&tables));
        // The canary: one f32 alone does not do.
        tables.optics.iter_mut().for_each(|entry| entry.integral_rest = [0.0; 4]);
        assert!(worst(&tables) > 100.0, "{}", worst(&tables));
    }

    /// A spike of a hundredth of a cell, and a jump, both within a cell.
    #[test]
    fn features_within_a_cell_are_seen_from_within() {
        let cell = 1.0 / TABLE_CELLS as f64;
        let at = |u: f64| (500.0 + u) * cell;
        let points =
            [(0.30, 0.0), (0.305, 1e3), (0.31, 0.0), (0.6, 0.0), (0.6, 2.0)].map(|(u, v)| (at(u), v));
        let curve = Curve::new(points.to_vec()).unwrap();
        let tables = tables(points.to_vec());
        for (from, to) in
            [(0.1, 0.9), (0.2, 0.304), (0.302, 0.309), (0.4, 0.5), (0.59, 0.61), (0.65, 0.7), (0.31, 3.0)]
        {
            let (s0, s1) = (at(from), at(to));
            let parts = 200_000;
            let width = (s1 - s0) / f64::from(parts);
            let sum: f64 = (0..parts).map(|i| curve.at(s0 + (f64::from(i) + 0.5) * width)).sum();
            let truth = sum / f64::from(parts);
            let of = |found: f64| (found - truth).abs() / (truth + 1e-3);
            let in_f64 = optics_between(&tables, &locate(&tables, s0), &locate(&tables, s1))[3];
            // Nodes stand at numbers of f32, here to 3e-5 of a cell.
            assert!(of(in_f64) < 0.02, "{from} to {to}: {in_f64} for {truth}");
            let in_f32 = f64::from(mean(&tables, s0 as f32, s1 as f32));
            assert!(of(in_f32) < 0.05, "{from} to {to}: {in_f32} for {truth}");
        }
    }

    #[test]
    fn the_end_of_the_range_is_what_it_jumps_to() {
        let tables = tables(vec![(0.5, 1.0), (1.0, 1.0), (1.0, 7.0)]);
        assert_eq!(locate(&tables, 1.0f32).value[3], 7.0);
        assert_eq!(mean(&tables, 1.0, 1.0), 7.0);
        assert_eq!(locate(&tables, 0.999_999f32).value[3], 1.0);
        assert!((mean(&tables, 0.9, 1.0) - 1.0).abs() < 1e-5);
    }

    proptest! {
        #[test]
        fn means_lie_within_the_curve_and_are_symmetric(
            values in prop::collection::vec(0.0..10.0f64, 5), s0 in 0.0..=1.0f32, s1 in 0.0..=1.0f32,
        ) {
            let points: Vec<_> = values.iter().enumerate().map(|(i, &v)| (i as f64 / 4.0, v)).collect();
            let most = values.iter().fold(0.0f64, |m, &v| m.max(v)) as f32;
            let tables = tables(points);
            let found = mean(&tables, s0, s1);
            prop_assert!(found >= 0.0 && found <= most * 1.0001 + 1e-6);
            prop_assert_eq!(found, mean(&tables, s1, s0));
        }
    }
}
