//! Pre-integrated transfer functions: curves made into tables of f and F = ∫ f.

mod integral;
mod nodes;

pub use nodes::TABLE_CELLS;

use crate::{Needs, Way};
use glam::DVec3;
use integral::integrate;
use layout::{ImportanceEntry, IndexEntry, TableCell, TableEntry};
use nodes::{Knots, Node, Nodes};
use optics::{Curve, Material, Optics};

/// All tables of an optical model. They share their nodes: s = i / TABLE_CELLS, and wherever a curve bends or jumps, so
/// that no feature is too narrow for them; and a few where τ c is far from straight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// Where to find the nodes of each of TABLE_CELLS equal cells, and what to pass over; the last entry ends the last cell.
    pub cells: Vec<TableCell>,
    /// (τ c, τ).
    pub optics: Vec<TableEntry>,
    /// ι; empty if importance plays no part.
    pub importance: Vec<ImportanceEntry>,
    /// Rows of as many entries as that table: row j holds at i the largest importance of the 2^j nodes from node i on.
    pub importance_most: Vec<f32>,
    /// ν, which is the integral of its own slope; empty if light is not bent.
    pub index: Vec<IndexEntry>,
    /// Ambient, diffuse, specular, shininess; empty if all scalars have the light's own.
    pub materials: Vec<TableEntry>,
}

impl Tables {
    /// The tables that a kernel for these optics and needs reads.
    pub fn new(optics: &Optics, needs: &Needs) -> Self {
        let mimda = optics.mimda.as_ref().filter(|_| needs.reads_importance());
        let importance = mimda.map(|mimda| &mimda.importance);
        let index = optics.refraction.as_ref().filter(|_| needs.way == Way::Refracted);
        let materials = optics.materials.as_ref().filter(|_| needs.has_materials);
        let mut knots = Knots::default();
        knots.add(&optics.extinction);
        knots.add(&optics.colour);
        importance.into_iter().chain(index).for_each(|curve| knots.add(curve));
        materials.into_iter().for_each(|curve| knots.add(curve));
        let Nodes { all: nodes, first } =
            Nodes::new(knots).halved(COLOUR_ERROR, |ends| colour_error(ends, optics));
        let table = optics_table(&nodes, optics);
        let importance = importance.map_or(Vec::new(), |curve| importance_table(&nodes, curve));
        let index = index.map_or(Vec::new(), |curve| index_table(&nodes, curve));
        let acts = |cell: usize| {
            let nodes_of_cell = index.get(first[cell]..=first[cell + 1]);
            let bends = nodes_of_cell
                .is_some_and(|index| index.windows(2).any(|ends| ends[0].value != ends[1].value));
            let [lo, hi] = [cell, cell + 1].map(|border| nodes[first[border]].s);
            // In f32, as kernels know it.
            bends || optics.most_importance_on(lo, hi) as f32 > 0.0
        };
        Self {
            cells: cells(&first, &table, acts),
            optics: table,
            importance_most: largest_of_spans(&importance),
            importance,
            index,
            materials: materials.map_or(Vec::new(), |curve| material_table(&nodes, curve)),
        }
    }

    /// Whether a cell has more nodes inside than it lists.
    pub fn is_crowded(&self) -> bool {
        let listed = 1 + TableCell::LISTED as u32;
        self.cells.windows(2).any(|ends| ends[1].first - ends[0].first > listed)
    }

    /// Whether nothing within scalars [low, high] changes a picture. A scalar that rounds into the next cell is
    /// taken to lie there.
    pub fn is_vacant(&self, low: f64, high: f64) -> bool {
        let cell = |s: f64| ((s.clamp(0.0, 1.0) * TABLE_CELLS as f64) as usize).min(TABLE_CELLS - 1);
        const ROUNDING: f64 = 1e-6;
        self.cells[cell(low - ROUNDING)].occupied == self.cells[cell(high + ROUNDING) + 1].occupied
    }
}

/// How far the colour of what lies between two nodes may be off, of 1: a fortieth of a code.
const COLOUR_ERROR: f64 = 1e-4;

/// How far it is off on average: where both are straight, τ c is below its chord by t (1 − t) Δτ Δc, t of the way on.
fn colour_error([a, b]: [Node; 2], optics: &Optics) -> f64 {
    let [tau, next_tau] = [a, b].map(|node| node.value(&optics.extinction));
    let [colour, next_colour] = [a, b].map(|node| node.value(&optics.colour));
    let product = (next_tau - tau).abs() * (next_colour - colour).abs().max_element();
    if product > 0.0 { product / (3.0 * (tau + next_tau)) } else { 0.0 }
}

fn entries(nodes: &[Node], f: impl Fn(Node) -> [f64; 4]) -> Vec<TableEntry> {
    let integrated = integrate(nodes, f).into_iter();
    integrated
        .zip(nodes)
        .map(|((value, integral, integral_rest), node)| TableEntry {
            value: value.map(|v| v as f32),
            integral,
            integral_rest,
            position: (node.s * TABLE_CELLS as f64) as f32,
            padding: [0.0; 3],
        })
        .collect()
}

/// The table of (τ c, τ).
fn optics_table(nodes: &[Node], optics: &Optics) -> Vec<TableEntry> {
    entries(nodes, |node| {
        let tau = node.value(&optics.extinction);
        let k: DVec3 = node.value(&optics.colour) * tau;
        [k.x, k.y, k.z, tau]
    })
}

fn material_table(nodes: &[Node], materials: &Curve<Material>) -> Vec<TableEntry> {
    entries(nodes, |node| node.value(materials).to_array())
}

/// A piece of ν that is narrower than this many table cells is a jump: no step resolves it.
const JUMP_CELLS: f64 = 0.01;
/// A change that is smaller is none: light goes on as it was.
const JUMP: f64 = 1e-3;

fn index_table(nodes: &[Node], index: &Curve<f64>) -> Vec<IndexEntry> {
    let values: Vec<f64> = nodes.iter().map(|node| node.value(index)).collect();
    let mut jumps = 0;
    let cells = |i: usize| (nodes[i].s - nodes[i - 1].s) * TABLE_CELLS as f64;
    let entry = |(i, &value): (usize, &f64)| {
        let is_jump = i > 0 && (value - values[i - 1]).abs() > JUMP && cells(i) < JUMP_CELLS;
        jumps += u32::from(is_jump);
        let next = values.get(i + 1).filter(|_| cells(i + 1) > 0.0);
        let slope = next.map_or(0.0, |next| (next - value) / cells(i + 1));
        IndexEntry { value: value as f32, slope: slope as f32, jumps }
    };
    values.iter().enumerate().map(entry).collect()
}

fn importance_table(nodes: &[Node], importance: &Curve<f64>) -> Vec<ImportanceEntry> {
    integrate(nodes, |node| [node.value(importance)])
        .into_iter()
        .map(|([value], [integral], [integral_rest])| ImportanceEntry {
            value: value as f32,
            integral,
            integral_rest,
            padding: 0.0,
        })
        .collect()
}

/// The cells, of which those with extinction change a picture, and those for which `acts` is true.
fn cells(first: &[usize], optics: &[TableEntry], acts: impl Fn(usize) -> bool) -> Vec<TableCell> {
    let has_extinction = |pair: &[TableEntry]| {
        let [a, b] = [&pair[0], &pair[1]];
        let grows = b.integral[3] > a.integral[3] || b.integral_rest[3] != a.integral_rest[3];
        a.value[3] > 0.0 || b.value[3] > 0.0 || grows
    };
    let mut occupied = 0;
    let mut cells: Vec<TableCell> = Vec::with_capacity(first.len());
    for (cell, ends) in first.windows(2).enumerate() {
        let mut inside = optics[ends[0] + 1..ends[1]].iter().map(|node| node.position);
        let inside = [(); TableCell::LISTED].map(|()| inside.next().unwrap_or(f32::MAX));
        cells.push(TableCell { first: ends[0] as u32, occupied, inside });
        occupied += u32::from(optics[ends[0]..=ends[1]].windows(2).any(has_extinction) || acts(cell));
    }
    cells.push(TableCell {
        first: first[first.len() - 1] as u32,
        occupied,
        inside: [f32::MAX; TableCell::LISTED],
    });
    cells
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

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: f64 = 1.0 / TABLE_CELLS as f64;

    fn of(points: Vec<(f64, f64)>) -> Tables {
        let colour = Curve::constant(DVec3::new(1.0, 0.5, 0.25));
        let optics = Optics::plain((0.0, 1.0), Curve::new(points).unwrap(), colour);
        Tables::new(&optics, &Needs::PLAIN)
    }

    /// The entry at the lower border of a cell.
    fn border(tables: &Tables, cell: usize) -> TableEntry {
        tables.optics[tables.cells[cell].first as usize]
    }

    #[test]
    fn integral_of_a_constant_counts_cells() {
        let tables = of(vec![(0.0, 2.0)]);
        assert_eq!(tables.optics.len(), TABLE_CELLS + 1);
        assert_eq!(tables.optics[0].integral[3], 0.0);
        assert_eq!(tables.optics[TABLE_CELLS].integral[3], 2.0 * TABLE_CELLS as f32);
        assert_eq!(tables.optics[7].value, [2.0, 1.0, 0.5, 2.0]);
        assert_eq!(tables.optics[7].position, 7.0);
    }

    #[test]
    fn a_spike_within_a_cell_has_nodes_of_its_own() {
        let (lo, peak, hi) = (100.25 * CELL, 100.5 * CELL, 100.75 * CELL);
        let tables = of(vec![(lo, 0.0), (peak, 1e6), (hi, 0.0)]);
        assert_eq!((border(&tables, 100).value[3], border(&tables, 101).value[3]), (0.0, 0.0));
        assert!((f64::from(border(&tables, 101).integral[3]) - 0.25e6).abs() < 1.0);
        let spike = &tables.optics[101..104];
        assert_eq!(spike.iter().map(|entry| entry.value[3]).collect::<Vec<_>>(), [0.0, 1e6, 0.0]);
        assert_eq!(spike.iter().map(|entry| entry.position).collect::<Vec<_>>(), [100.25, 100.5, 100.75]);
    }

    /// Where extinction begins, what is seen of something opaque is a part of a cell, whose colour is not that at its end.
    #[test]
    fn colours_are_right_where_extinction_begins() {
        let extinction = Curve::new(vec![(500.3 * CELL, 0.0), (600.0 * CELL, 1e5)]).unwrap();
        let red = |u: f64| DVec3::new(u, 0.0, 0.0);
        let colour = Curve::new(vec![(500.0 * CELL, red(0.0)), (510.0 * CELL, red(1.0))]).unwrap();
        let optics = Optics::plain((0.0, 1.0), extinction, colour);
        let tables = Tables::new(&optics, &Needs::PLAIN);
        assert!(!tables.is_crowded());
        let table = &tables.optics;
        let error_at = |table: &[TableEntry], u: f64| {
            let next = table.iter().position(|entry| f64::from(entry.position) > u).unwrap();
            let [a, b] = [&table[next - 1], &table[next]].map(|entry| {
                (f64::from(entry.position), f64::from(entry.value[0]), f64::from(entry.value[3]))
            });
            let part = (u - a.0) / (b.0 - a.0);
            let [k, tau] = [a.1 + part * (b.1 - a.1), a.2 + part * (b.2 - a.2)];
            (k / tau - (u - 500.0) / 10.0).abs()
        };
        for u in [500.4, 500.6, 500.8, 501.5] {
            assert!(error_at(table, u) < 0.03, "{u}: {}", error_at(table, u));
        }
        // The canary: nodes at borders and knots alone.
        let bare: Vec<TableEntry> = table
            .iter()
            .filter(|entry| entry.position.fract() == 0.0 || (entry.position - 500.3).abs() < 1e-3)
            .copied()
            .collect();
        assert!(error_at(&bare, 500.4) > 0.05, "{}", error_at(&bare, 500.4));
    }

    #[test]
    fn a_jump_is_two_nodes() {
        let tables = of(vec![(0.5, 0.0), (0.5, 1.0)]);
        assert!(
            (f64::from(border(&tables, TABLE_CELLS).integral[3]) - 0.5 * TABLE_CELLS as f64).abs() < 1e-3
        );
        assert_eq!(
            [512, 513].map(|node| (tables.optics[node].position, tables.optics[node].value[3])),
            [(511.5, 0.0), (511.5, 1.0)]
        );
    }

    #[test]
    fn two_floats_hold_an_integral_to_fourteen_digits() {
        for entry in of(vec![(0.0, 0.1), (0.3, 1e6), (1.0, 1e-6)]).optics {
            let sum = f64::from(entry.integral[3]) + f64::from(entry.integral_rest[3]);
            assert!(sum.is_finite() && entry.integral_rest[3].abs() <= entry.integral[3] * 6e-8 + 1e-30);
        }
    }

    #[test]
    fn spans_of_nodes_know_their_largest() {
        let points = vec![(0.0, 0.1), (0.3, 0.8), (0.31, 0.2), (0.9, 0.4), (1.0, 0.0)];
        let importance = Curve::new(points).unwrap();
        let mut knots = Knots::default();
        knots.add(&importance);
        let table = importance_table(&Nodes::new(knots).all, &importance);
        let rows = largest_of_spans(&table);
        for (row, first) in [(0, 5), (3, 300), (7, 250), (9, 0), (9, 512)] {
            let nodes = &table[first..(first + (1 << row)).min(table.len())];
            let truth = nodes.iter().map(|entry| entry.value).fold(0.0, f32::max);
            assert_eq!(rows[row * table.len() + first], truth, "{row} {first}");
        }
    }

    #[test]
    fn occupied_cells_are_counted() {
        let spike = of(vec![(10.2 * CELL, 0.0), (10.5 * CELL, 1.0), (10.8 * CELL, 0.0)]);
        let counts = |cells: &[TableCell]| [10, 11, TABLE_CELLS].map(|cell| cells[cell].occupied);
        assert_eq!(counts(&spike.cells), [0, 1, 1]);
        let first: Vec<usize> = spike.cells.iter().map(|cell| cell.first as usize).collect();
        let acting = cells(&first, &spike.optics, |cell| cell >= 500);
        assert_eq!(counts(&acting), [0, 1, 1 + 523]);
    }

    #[test]
    fn jumps_of_the_index_are_counted_and_slopes_keep_their_digits() {
        let points = vec![(0.2, 1.0), (0.4, 1.2), (0.4, 1.5), (0.7, 1.5), (0.7 + 1e-7, 1.1), (1.0, 1.1)];
        let mut optics = Optics::grey(Curve::constant(1.0));
        optics.refraction = Some(Curve::new(points).unwrap());
        let tables = Tables::new(&optics, &Needs { way: Way::Refracted, ..Needs::PLAIN });
        let at = |s: f64| tables.index[tables.cells[(s * TABLE_CELLS as f64) as usize].first as usize];
        assert_eq!([0.1, 0.3, 0.5, 0.8].map(|s| at(s).jumps), [0, 0, 1, 2]);
        assert_eq!([0.1, 0.5, 0.8].map(|s| at(s).slope), [0.0; 3]);
        let slope = 1.0 / TABLE_CELLS as f32;
        assert!((at(0.3).slope / slope - 1.0).abs() < 1e-6, "{} per cell", at(0.3).slope);
    }
}
