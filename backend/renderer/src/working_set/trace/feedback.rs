//! What rays would have reported of a cut.

use super::Demand;
use crate::working_set::Feedback;
use bricks::LodRule;
use bricks::{NodeKey, OctreeShape};
use std::collections::HashMap;

/// The feedback of a frame's demand on any cut: of each leaf that rays meet, how much too coarse it is and how many rays
/// say so, in the order of `leaves`. A leaf is seen where it overlaps a demanded node:
/// - one that holds demanded nodes gets all their rays, since it would have been sampled in their place;
/// - a demanded node above several leaves shares its rays out among them, as their cross-sections go, but at least one
///   to each: nothing shows which of them the rays met.
///
/// So the rays of a demanded node that lies over fewer leaves than it has rays are as many afterwards as before.
/// `leaves` are those that rays could meet: the caller leaves out what is empty by the transfer functions.
pub fn feedback_on(
    demand: &Demand,
    rule: &LodRule,
    shape: &OctreeShape,
    leaves: impl Iterator<Item = NodeKey>,
) -> Vec<Feedback> {
    let leaves: Vec<NodeKey> = leaves.collect();
    let number: HashMap<NodeKey, usize> = leaves.iter().enumerate().map(|(i, &leaf)| (leaf, i)).collect();
    let mut rays = vec![0u32; leaves.len()];
    let mut spread: HashMap<NodeKey, (u32, Vec<usize>)> = HashMap::new();
    for node in demand.nodes() {
        match itself_and_above(node.key).find_map(|key| number.get(&key)) {
            Some(&leaf) => rays[leaf] = rays[leaf].saturating_add(node.rays),
            None => _ = spread.insert(node.key, (node.rays, Vec::new())),
        }
    }
    for (i, leaf) in leaves.iter().enumerate() {
        for above in itself_and_above(*leaf) {
            if let Some((_, below)) = spread.get_mut(&above) {
                below.push(i);
            }
        }
    }
    for (of_node, below) in spread.into_values() {
        let depths: Vec<u8> = below.iter().map(|&i| leaves[i].depth).collect();
        for (i, share) in below.into_iter().zip(shares(of_node, &depths)) {
            rays[i] = rays[i].saturating_add(share);
        }
    }
    let met = leaves.iter().zip(rays).filter(|&(_, rays)| rays > 0);
    met.map(|(&key, rays)| Feedback { key, rays, deficit: deficit(rule, shape, key) }).collect()
}

/// As rays read it in the index, in f32.
fn deficit(rule: &LodRule, shape: &OctreeShape, key: NodeKey) -> f64 {
    let deficit = rule.deficit(shape, key);
    f64::from((if key.depth == shape.finest_depth() { deficit.min(0.0) } else { deficit }) as f32)
}

fn itself_and_above(key: NodeKey) -> impl Iterator<Item = NodeKey> {
    std::iter::successors(Some(key), |key| key.parent())
}

/// Shares of `rays` for leaves at some depths: one each, and what is left by cross-section, which falls to a quarter from
/// a depth to the next. They add up to `rays` where that is enough for one each.
fn shares(rays: u32, depths: &[u8]) -> Vec<u32> {
    let deepest = depths.iter().copied().max().unwrap_or(0);
    let section = |&depth: &u8| 4f64.powi(i32::from(deepest - depth));
    let whole: f64 = depths.iter().map(section).sum();
    let left = f64::from(rays.saturating_sub(depths.len() as u32));
    let (mut before, mut given) = (0.0, 0.0);
    let share = |depth| {
        before += section(depth);
        // Sums of powers of four are exact, so the last one comes to all that is left.
        let until = (left * (before / whole)).floor();
        let share = 1 + (until - given) as u32;
        given = until;
        share
    };
    depths.iter().map(share).collect()
}
