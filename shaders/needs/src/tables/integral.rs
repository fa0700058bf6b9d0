//! Integrals of piecewise quadratic functions, from node to node.

use super::nodes::{Node, TABLE_CELLS};

/// f and F = ∫ f at every node, F as a pair of f32. F is in units of table cells, so that kernels divide by a difference
/// of positions. Simpson's rule is exact for functions that are quadratic between nodes.
pub(super) fn integrate<const N: usize>(
    nodes: &[Node],
    f: impl Fn(Node) -> [f64; N],
) -> Vec<([f64; N], [f32; N], [f32; N])> {
    let mut sums = [Sum::default(); N];
    let mut before: Option<(Node, [f64; N])> = None;
    nodes
        .iter()
        .map(|&node| {
            let value = f(node);
            if let Some((from, first)) = before {
                let middle = f(Node { s: 0.5 * (from.s + node.s), is_below: false });
                let width = (node.s - from.s) * TABLE_CELLS as f64;
                for c in 0..N {
                    sums[c].add(width / 6.0 * (first[c] + 4.0 * middle[c] + value[c]));
                }
            }
            before = Some((node, value));
            let (hi, rest) = split(sums);
            (value, hi, rest)
        })
        .collect()
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
