//! The weights of a node's corners: how much of itself it shows there.

use super::vertices::{Around, BEYOND, visit_vertices};
use super::{Cut, IndexRules};
use bricks::is_shown;
use bricks::{NodeKey, NodeSummary};
use glam::IVec3;

/// What a coarser leaf lets finer neighbours show at a corner, from its place and from the cell one level above the
/// corner's leaf that lies in it.
trait Permission: Fn(u32, NodeKey) -> f32 {}

impl<F: Fn(u32, NodeKey) -> f32> Permission for F {}

/// The weights of corners x + 2 y + 4 z of every place: for leaves that rays meet, the least share of all cells around the
/// corner at the leaf's depth. A cell that is covered by a coarser leaf has what that leaf permits; a finer one is whole.
/// All leaves of a depth that share a corner have the same weight there. Other places have full weights.
/// Where the detail below a leaf `is_lost`, the rule of detail decides, as in [`settled_weights`].
pub fn corner_weights(
    cut: &Cut,
    rules: &IndexRules,
    summary: &dyn Fn(NodeKey) -> NodeSummary,
    is_lost: impl Fn(NodeKey) -> bool,
) -> Vec<[f32; 8]> {
    weigh_all(cut, |place, key| {
        let node = cut.node(place);
        if is_lost(node.key) { settled(rules, summary, key) } else { node.permits }
    })
}

/// The same where everything is shown at once, see [`super::settle`]: by the rule of detail alone, whatever is resident.
/// A corner has no weight where the cut that the rule asks for has a coarser leaf that shows something, and full weight
/// elsewhere.
pub fn settled_weights(
    cut: &Cut,
    rules: &IndexRules,
    summary: &dyn Fn(NodeKey) -> NodeSummary,
) -> Vec<[f32; 8]> {
    weigh_all(cut, |_, key| settled(rules, summary, key))
}

/// What the cell `key` lets finer neighbours show, by the rule of detail alone.
fn settled(rules: &IndexRules, summary: &dyn Fn(NodeKey) -> NodeSummary, key: NodeKey) -> f32 {
    let is_border = rules.shape.contains(key)
        && rules.lod.is_fine_enough(rules.shape, key)
        && is_shown(rules.optics, summary(key));
    if is_border { 0.0 } else { 1.0 }
}

/// What a corner asks of a node.
#[derive(Clone, Copy)]
struct Share {
    shown: f32,
    depth: u8,
}

fn weigh_all(cut: &Cut, permits: impl Permission) -> Vec<[f32; 8]> {
    let mut weights = vec![[1.0; 8]; cut.nodes().len()];
    let shares: Vec<Share> =
        cut.nodes().iter().map(|node| Share { shown: node.shown, depth: node.key.depth }).collect();
    visit_vertices(cut, &mut |around| weigh(cut, &shares, around, &permits, &mut weights));
    weights
}

fn weigh(cut: &Cut, shares: &[Share], around: &Around, permits: &impl Permission, weights: &mut [[f32; 8]]) {
    let (mut coarsest, mut finest, mut least) = (u8::MAX, 0, 1.0_f32);
    for &place in around.iter().filter(|&&place| place != BEYOND) {
        let Share { shown, depth } = shares[place as usize];
        (coarsest, finest, least) = (coarsest.min(depth), finest.max(depth), least.min(shown));
    }
    // Mostly everything around is whole.
    if coarsest >= finest && least == 1.0 {
        return;
    }
    for (octant, &place) in around.iter().enumerate().filter(|&(_, &place)| place != BEYOND) {
        // A point on a face or an edge of a larger leaf is not a corner of it.
        if around.iter().filter(|&&other| other == place).count() == 1 {
            weights[place as usize][7 ^ octant] = least_share(cut, shares, around, octant, permits);
        }
    }
}

/// The least share, of the cells around a vertex, at the depth of the leaf in an octant.
fn least_share(
    cut: &Cut,
    shares: &[Share],
    around: &Around,
    octant: usize,
    permits: &impl Permission,
) -> f32 {
    let own = cut.node(around[octant]).key;
    let mut least = 1.0_f32;
    for (other, &place) in around.iter().enumerate().filter(|&(_, &place)| place != BEYOND) {
        let Share { shown, depth } = shares[place as usize];
        least = least.min(match depth.cmp(&own.depth) {
            std::cmp::Ordering::Less => permits(place, above(own, octant, other)),
            std::cmp::Ordering::Equal => shown,
            std::cmp::Ordering::Greater => 1.0,
        });
    }
    least
}

/// The parent of the cell in octant `other` around a vertex, at the depth of the leaf `own` in octant `octant`.
fn above(own: NodeKey, octant: usize, other: usize) -> NodeKey {
    let bits = |octant: usize| IVec3::from_array([0, 1, 2].map(|axis| (octant >> axis & 1) as i32));
    let cell = own.cell.as_ivec3() + bits(other) - bits(octant);
    NodeKey { depth: own.depth - 1, cell: (cell / 2).as_uvec3() }
}
