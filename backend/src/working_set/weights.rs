//! The weights of a node's corners: how much of itself it shows there.

use super::Cut;
use super::vertices::{Around, visit_vertices};

/// The weights of corners x + 2 y + 4 z of every place: for leaves that rays meet, the least share of all cells around the
/// corner at the leaf's depth. A cell that is covered by a coarser leaf has what that leaf permits; a finer one is whole.
/// All leaves of a depth that share a corner have the same weight there. Other places have full weights.
pub fn corner_weights(cut: &Cut) -> Vec<[f32; 8]> {
    let mut weights = vec![[1.0; 8]; cut.nodes().len()];
    visit_vertices(cut, &mut |around| weigh(cut, around, &mut weights));
    weights
}

fn weigh(cut: &Cut, around: &Around, weights: &mut [[f32; 8]]) {
    let depth = |place: &u32| cut.node(*place).key.depth;
    let depths = || around.iter().flatten().map(depth);
    let (Some(coarsest), Some(finest)) = (depths().min(), depths().max()) else { return };
    // Mostly everything around is whole.
    if coarsest == finest && around.iter().flatten().all(|&place| cut.node(place).shown == 1.0) {
        return;
    }
    for (octant, place) in around.iter().enumerate() {
        let Some(place) = *place else { continue };
        // On a face or an edge of a larger leaf there is no corner of it.
        if around.iter().filter(|&&other| other == Some(place)).count() > 1 {
            continue;
        }
        weights[place as usize][7 ^ octant] = least_share(cut, around, depth(&place));
    }
}

/// The least share, of the cells around a vertex, at a depth.
fn least_share(cut: &Cut, around: &Around, depth: u8) -> f32 {
    around.iter().flatten().fold(1.0, |least, &place| {
        let node = cut.node(place);
        least.min(match node.key.depth.cmp(&depth) {
            std::cmp::Ordering::Less => node.permits,
            std::cmp::Ordering::Equal => node.shown,
            std::cmp::Ordering::Greater => 1.0,
        })
    })
}
