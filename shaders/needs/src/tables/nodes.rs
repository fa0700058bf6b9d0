//! Where tables hold values.

use layout::TableCell;
use optics::{Curve, CurveValue};

/// Equal cells of [0, 1], by which nodes are found.
pub const TABLE_CELLS: usize = 1023;

/// Narrower pieces are not halved: numbers of f32 hold a place among a thousand cells to a few hundred-thousandths of one.
const NARROWEST_CELLS: f64 = 0.01;

/// A place in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// The scalar.
    pub(super) s: f64,
    /// Whether the node holds what functions are just below it, where one jumps.
    pub(super) is_below: bool,
}

impl Node {
    /// The value of a curve.
    pub(super) fn value<V: CurveValue>(&self, curve: &Curve<V>) -> V {
        if self.is_below { curve.just_below(self.s) } else { curve.at(self.s) }
    }
}

/// The nodes of some curves: the borders of the cells and all knots, so that every curve is linear from node to node. A
/// jump is two nodes.
pub(super) struct Nodes {
    /// In rising order.
    pub(super) all: Vec<Node>,
    /// The node at the lower border of each cell, then the last.
    pub(super) first: Vec<usize>,
}

/// The knots of curves, and which of them are jumps.
#[derive(Default)]
pub(super) struct Knots(Vec<(f64, bool)>);

impl Knots {
    /// Adds those of a curve.
    pub(super) fn add<V: CurveValue>(&mut self, curve: &Curve<V>) {
        let jumps = |s: f64| curve.at(s) != curve.just_below(s);
        let inside = curve.points().iter().map(|point| point.0).filter(|&s| s > 0.0 && s <= 1.0);
        self.0.extend(inside.map(|s| (s, jumps(s))));
    }

    /// In rising order, each once.
    fn sorted(mut self) -> Vec<(f64, bool)> {
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.0.dedup_by(|next, kept| {
            let is_same = next.0 == kept.0;
            kept.1 |= is_same && next.1;
            is_same
        });
        self.0
    }
}

impl Nodes {
    /// Of curves with these knots.
    pub(super) fn new(knots: Knots) -> Self {
        let knots = knots.sorted();
        let mut knots = knots.into_iter().peekable();
        let mut nodes = Self { all: Vec::new(), first: Vec::new() };
        for border in 0..=TABLE_CELLS {
            let s = border as f64 / TABLE_CELLS as f64;
            while let Some((knot, jumps)) = knots.next_if(|&(knot, _)| knot <= s) {
                if jumps {
                    nodes.all.push(Node { s: knot, is_below: true });
                }
                if knot < s {
                    nodes.all.push(Node { s: knot, is_below: false });
                }
            }
            nodes.first.push(nodes.all.len());
            nodes.all.push(Node { s, is_below: false });
        }
        nodes
    }

    /// Halves what lies between two nodes, the worst of a cell first, while `error` of it is more than `most` and the cell
    /// still lists its nodes.
    pub(super) fn halved(self, most: f64, error: impl Fn([Node; 2]) -> f64) -> Self {
        let narrowest = 2.0 * NARROWEST_CELLS / TABLE_CELLS as f64;
        let error = |ends: [Node; 2]| if ends[1].s - ends[0].s < narrowest { 0.0 } else { error(ends) };
        let mut halved = Self { all: Vec::with_capacity(self.all.len()), first: Vec::new() };
        for ends in self.first.windows(2) {
            let mut cell = self.all[ends[0]..=ends[1]].to_vec();
            while cell.len() < 2 + TableCell::LISTED {
                let errors = cell.windows(2).map(|ends| error([ends[0], ends[1]])).enumerate();
                let Some((worst, _)) =
                    errors.filter(|(_, error)| *error > most).max_by(|a, b| a.1.total_cmp(&b.1))
                else {
                    break;
                };
                let middle = Node { s: 0.5 * (cell[worst].s + cell[worst + 1].s), is_below: false };
                cell.insert(worst + 1, middle);
            }
            halved.first.push(halved.all.len());
            halved.all.extend(&cell[..cell.len() - 1]);
        }
        halved.first.push(halved.all.len());
        halved.all.extend(self.all.last());
        halved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_borders_and_knots_in_rising_order() {
        let cell = 1.0 / TABLE_CELLS as f64;
        let (kink, jump) = (5.5 * cell, 1.0 / 3.0);
        let mut knots = Knots::default();
        knots.add(&Curve::new(vec![(0.0, 1.0), (kink, 2.0), (jump, 2.0), (jump, 1.0), (1.0, 0.0)]).unwrap());
        knots.add(&Curve::new(vec![(kink, 2.0), (1.0, 3.0), (1.0, 0.5)]).unwrap());
        let nodes = Nodes::new(knots);
        // A kink, a jump on the border of cell 341, and one at the end.
        assert_eq!(nodes.all.len(), TABLE_CELLS + 1 + 1 + 1 + 1);
        assert!(nodes.all.is_sorted_by(|a, b| a.s <= b.s));
        assert_eq!(nodes.all[6], Node { s: kink, is_below: false });
        assert_eq!((nodes.first[5], nodes.first[6], nodes.first[341]), (5, 7, 343));
        assert_eq!(nodes.all[342..344].iter().map(|node| node.is_below).collect::<Vec<_>>(), [true, false]);
        assert_eq!(nodes.first[TABLE_CELLS], nodes.all.len() - 1);
        assert!(nodes.all[nodes.all.len() - 2].is_below);
    }

    #[test]
    fn what_errs_most_is_halved_while_a_cell_lists_its_nodes() {
        let mut knots = Knots::default();
        let cell = 1.0 / TABLE_CELLS as f64;
        knots.add(&Curve::new(vec![(7.5 * cell, 1.0), (9.3 * cell, 2.0), (9.6 * cell, 1.0)]).unwrap());
        let before = Nodes::new(knots);
        // All between cells 5 and 10 errs by its width, and a little more farther up.
        let error = |[a, b]: [Node; 2]| {
            if a.s >= 4.9 * cell && b.s <= 10.1 * cell { (b.s - a.s) / cell * (1.0 + a.s) } else { 0.0 }
        };
        let nodes = before.halved(0.3, error);
        let inside = |index: usize| -> Vec<f64> {
            let nodes = &nodes.all[nodes.first[index] + 1..nodes.first[index + 1]];
            nodes.iter().map(|node| ((node.s / cell - index as f64) * 1e3).round() / 1e3).collect()
        };
        assert_eq!(inside(4), []);
        assert_eq!(inside(5), [0.5, 0.75]);
        assert_eq!((inside(7), inside(9)), (vec![0.5, 0.75], vec![0.3, 0.6]));
        assert_eq!((nodes.all.len(), nodes.first.len()), (nodes.first[TABLE_CELLS] + 1, TABLE_CELLS + 1));
        assert!(nodes.all.is_sorted_by(|a, b| a.s <= b.s));
    }
}
