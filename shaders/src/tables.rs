//! Pre-integrated transfer functions: curves made into tables of f and F = ∫ f.

use crate::needs::{Needs, Way};
use glam::DVec3;
use layout::{ImportanceEntry, OpticsEntry};
use optics::{Curve, Optics};

/// Entries of a table: nodes at s = i / (TABLE_ENTRIES − 1).
pub const TABLE_ENTRIES: usize = 1024;

/// All tables of an optical model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// (τ c, τ).
    pub optics: Vec<OpticsEntry>,
    /// ι; empty if importance plays no part.
    pub importance: Vec<ImportanceEntry>,
    /// Rows of as many entries as that table: row j holds at i the largest importance of the 2^j nodes from node i on.
    pub importance_most: Vec<f32>,
    /// ν, which is the integral of its own slope; empty if light is not bent. A jump becomes the slope of one cell.
    pub index: Vec<f32>,
    /// Ambient, diffuse, specular, shininess; empty if all scalars have the light's own.
    pub materials: Vec<[f32; 4]>,
    /// See [`occupancy`].
    pub occupied: Vec<u32>,
}

impl Tables {
    /// The tables that a kernel for these optics and needs reads.
    pub fn new(optics: &Optics, needs: &Needs) -> Self {
        let importance = match &optics.mimda {
            Some(mimda) if needs.reads_importance() => importance_table(&mimda.importance),
            Some(_) | None => Vec::new(),
        };
        let index = match (&optics.refraction, needs.way) {
            (Some(index), Way::Refracted) => nodes().map(|s| index.at(s) as f32).collect(),
            (Some(_) | None, _) => Vec::new(),
        };
        let materials = match &optics.materials {
            Some(materials) if needs.has_materials => {
                nodes().map(|s| materials.at(s).to_array().map(|factor| factor as f32)).collect()
            }
            Some(_) | None => Vec::new(),
        };
        let table = optics_table(optics);
        let occupied = occupancy(&table, |cell| {
            let bends = index.get(cell..cell + 2).is_some_and(|pair| pair[0] != pair[1]);
            let [lo, hi] = [cell, cell + 1].map(|node| node as f64 / (TABLE_ENTRIES - 1) as f64);
            // In f32, as kernels know it.
            bends || optics.most_importance_on(lo, hi) as f32 > 0.0
        });
        let importance_most = largest_of_spans(&importance);
        Self { optics: table, importance, importance_most, index, materials, occupied }
    }

    /// Whether nothing within scalars [low, high] changes a picture. A scalar that rounds into the next cell is
    /// taken to lie there.
    pub fn is_vacant(&self, low: f64, high: f64) -> bool {
        let cells = (TABLE_ENTRIES - 1) as f64;
        let cell = |s: f64| ((s.clamp(0.0, 1.0) * cells) as usize).min(TABLE_ENTRIES - 2);
        const ROUNDING: f64 = 1e-6;
        self.occupied[cell(low - ROUNDING)] == self.occupied[cell(high + ROUNDING) + 1]
    }
}

/// The table of (τ c, τ). Values are the curve's at the nodes; integrals are exact, whatever the curve does between
/// nodes (τ c is quadratic between control points, so Simpson's rule is exact there).
pub fn optics_table(optics: &Optics) -> Vec<OpticsEntry> {
    let value = |s: f64, tau: f64| -> [f64; 4] {
        let k = optics.colour.at(s) * tau;
        [k.x, k.y, k.z, tau]
    };
    let at = |s: f64| value(s, optics.extinction.at(s));
    let below = |s: f64| {
        let k: DVec3 = optics.colour.just_below(s) * optics.extinction.just_below(s);
        [k.x, k.y, k.z, optics.extinction.just_below(s)]
    };
    let knots = merged_knots(&optics.extinction, &optics.colour);
    integrate(&knots, at, below)
        .into_iter()
        .map(|(value, integral)| {
            let (hi, rest) = split(integral);
            OpticsEntry { value: value.map(|v| v as f32), integral: hi, integral_rest: rest }
        })
        .collect()
}

/// The table of an importance curve.
pub fn importance_table(importance: &Curve<f64>) -> Vec<ImportanceEntry> {
    let knots: Vec<f64> = importance.knots_between(0.0, 1.0).collect();
    integrate(&knots, |s| [importance.at(s)], |s| [importance.just_below(s)])
        .into_iter()
        .map(|(value, integral)| {
            let ([hi], [rest]) = split(integral);
            ImportanceEntry { value: value[0] as f32, integral: hi, integral_rest: rest, padding: 0.0 }
        })
        .collect()
}

/// How many table cells below each node change a picture: cells with any extinction, and those for which `acts` is true.
/// So cells a to b together change nothing if the counts at a and b + 1 are equal.
pub fn occupancy(optics: &[OpticsEntry], acts: impl Fn(usize) -> bool) -> Vec<u32> {
    let has_extinction = |a: &OpticsEntry, b: &OpticsEntry| {
        let grows = b.integral[3] > a.integral[3] || b.integral_rest[3] != a.integral_rest[3];
        a.value[3] > 0.0 || b.value[3] > 0.0 || grows
    };
    let mut count = 0;
    let counts = optics.windows(2).enumerate().map(|(cell, pair)| {
        count += u32::from(has_extinction(&pair[0], &pair[1]) || acts(cell));
        count
    });
    std::iter::once(0).chain(counts).collect()
}

/// See [`Tables::importance_most`].
fn largest_of_spans(importance: &[ImportanceEntry]) -> Vec<f32> {
    let mut rows: Vec<f32> = importance.iter().map(|entry| entry.value).collect();
    let entries = rows.len();
    let mut span = 1;
    while 2 * span <= entries {
        let row = rows.len() - entries;
        for i in 0..entries {
            let beyond = rows.get(row + i + span).filter(|_| i + span < entries).copied();
            rows.push(beyond.map_or(rows[row + i], |other| other.max(rows[row + i])));
        }
        span *= 2;
    }
    rows
}

/// The scalars of a table's nodes.
fn nodes() -> impl Iterator<Item = f64> {
    (0..TABLE_ENTRIES).map(|node| node as f64 / (TABLE_ENTRIES - 1) as f64)
}

fn merged_knots(extinction: &Curve<f64>, colour: &Curve<DVec3>) -> Vec<f64> {
    let mut knots: Vec<f64> =
        extinction.knots_between(0.0, 1.0).chain(colour.knots_between(0.0, 1.0)).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

/// f and F at every node; F in units of table cells, so that the kernel divides by a difference of indices.
fn integrate<const N: usize>(
    knots: &[f64],
    at: impl Fn(f64) -> [f64; N],
    below: impl Fn(f64) -> [f64; N],
) -> Vec<([f64; N], [Sum; N])> {
    let cells = (TABLE_ENTRIES - 1) as f64;
    let mut sums = [Sum::default(); N];
    let mut table = vec![(at(0.0), sums)];
    let mut next_knot = 0;
    for node in 1..TABLE_ENTRIES {
        let (mut from, to) = ((node - 1) as f64 / cells, node as f64 / cells);
        loop {
            let knot = knots.get(next_knot).copied().filter(|&k| k <= to);
            let until = knot.unwrap_or(to);
            let (first, middle, last) = (at(from), at(0.5 * (from + until)), below(until));
            for c in 0..N {
                sums[c].add((until - from) * cells / 6.0 * (first[c] + 4.0 * middle[c] + last[c]));
            }
            from = until;
            match knot {
                Some(_) => next_knot += 1,
                None => break,
            }
        }
        table.push((at(to), sums));
    }
    table
}

/// A sum that keeps what each addition rounds off (Neumaier): a tail of 1e-6 must survive behind a head of 1e8.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    total: f64,
    rest: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let total = self.total + term;
        self.rest +=
            if self.total >= term { (self.total - total) + term } else { (term - total) + self.total };
        self.total = total;
    }
}

/// Sums as pairs of f32, component by component.
fn split<const N: usize>(sums: [Sum; N]) -> ([f32; N], [f32; N]) {
    let hi = sums.map(|sum| sum.total as f32);
    let rest = std::array::from_fn(|c| (sums[c].total - f64::from(hi[c]) + sums[c].rest) as f32);
    (hi, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn optics(points: Vec<(f64, f64)>) -> Optics {
        let colour = Curve::constant(DVec3::new(1.0, 0.5, 0.25));
        Optics::plain((0.0, 1.0), Curve::new(points).unwrap(), colour)
    }

    #[test]
    fn integral_of_a_constant_counts_cells() {
        let table = optics_table(&optics(vec![(0.0, 2.0)]));
        assert_eq!(table[0].integral[3], 0.0);
        assert_eq!(table[TABLE_ENTRIES - 1].integral[3], 2.0 * (TABLE_ENTRIES - 1) as f32);
        assert_eq!(table[7].value, [2.0, 1.0, 0.5, 2.0]);
    }

    #[test]
    fn a_spike_between_two_nodes_is_not_lost() {
        let cells = (TABLE_ENTRIES - 1) as f64;
        let (lo, peak, hi) = (100.25 / cells, 100.5 / cells, 100.75 / cells);
        let table = optics_table(&optics(vec![(lo, 0.0), (peak, 1e6), (hi, 0.0)]));
        assert_eq!(table[100].value[3], 0.0);
        assert!((f64::from(table[101].integral[3]) - 0.25e6).abs() < 1.0);
    }

    #[test]
    fn a_jump_at_a_knot_takes_the_value_below_on_its_left() {
        let table = optics_table(&optics(vec![(0.5, 0.0), (0.5, 1.0)]));
        let total = f64::from(table[TABLE_ENTRIES - 1].integral[3]);
        assert!((total - 0.5 * (TABLE_ENTRIES - 1) as f64).abs() < 1e-3);
    }

    #[test]
    fn two_floats_hold_an_integral_to_fourteen_digits() {
        let table = optics_table(&optics(vec![(0.0, 0.1), (0.3, 1e6), (1.0, 1e-6)]));
        for entry in table {
            let sum = f64::from(entry.integral[3]) + f64::from(entry.integral_rest[3]);
            assert!(sum.is_finite() && entry.integral_rest[3].abs() <= entry.integral[3] * 6e-8 + 1e-30);
        }
    }

    #[test]
    fn spans_of_nodes_know_their_largest() {
        let importance =
            Curve::new(vec![(0.0, 0.1), (0.3, 0.8), (0.31, 0.2), (0.9, 0.4), (1.0, 0.0)]).unwrap();
        let table = importance_table(&importance);
        let rows = largest_of_spans(&table);
        for (row, first) in [(0, 5), (3, 300), (7, 250), (9, 0), (9, 512)] {
            let nodes = &table[first..(first + (1 << row)).min(TABLE_ENTRIES)];
            let truth = nodes.iter().map(|entry| entry.value).fold(0.0, f32::max);
            assert_eq!(rows[row * TABLE_ENTRIES + first], truth, "{row} {first}");
        }
    }

    #[test]
    fn occupancy_counts_cells_with_anything_in_them() {
        let cells = (TABLE_ENTRIES - 1) as f64;
        let spike =
            optics_table(&optics(vec![(10.2 / cells, 0.0), (10.5 / cells, 1.0), (10.8 / cells, 0.0)]));
        let counts = occupancy(&spike, |_| false);
        assert_eq!((counts[10], counts[11], counts[TABLE_ENTRIES - 1]), (0, 1, 1));
        assert_eq!(occupancy(&spike, |cell| cell >= 500)[TABLE_ENTRIES - 1], 1 + 523);
    }
}
