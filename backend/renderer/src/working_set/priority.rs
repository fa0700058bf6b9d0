//! Priorities of all nodes from what rays met: algorithm 1 of the paper on spatiotemporal blending.

use super::Cut;

/// The priority of every place, levels: how much too coarse a node is for the rays that met it or its kin; above that of
/// its children by one level at least, −∞ where no ray met it nor its kin.
///
/// `met` is the deficit of a place that a ray met, None for others; `order` is [`Cut::walk`].
pub fn priorities(cut: &Cut, order: &[u32], met: impl Fn(u32) -> Option<f64>) -> Vec<f64> {
    let mut priority = vec![f64::NEG_INFINITY; cut.nodes().len()];
    for &place in order {
        let told = met(place).unwrap_or(f64::NEG_INFINITY);
        let from_parent = cut.node(place).parent.map_or(f64::NEG_INFINITY, |p| priority[p as usize] - 1.0);
        priority[place as usize] = told.max(from_parent);
    }
    for &place in order.iter().rev() {
        if let Some(first) = cut.node(place).first_child {
            let children = &priority[first as usize..first as usize + 8];
            priority[place as usize] = children.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p + 1.0));
        }
    }
    priority
}
