//! A plane from the front to the back, in parts that are sampled alike.

use crate::leaves::Leaf;

/// Cells of a part at the widest spacing: what of it needs a closer one is found out for all of its depth.
const CELLS: usize = 4;

/// The widest distance between samples, in voxels of the finest leaf around: from one depth to the next, and from one column to
/// the next, at most.
const WIDEST: [f64; 2] = [1.0, 1.0];

/// Columns per pixel, at most: more are worth no memory.
const MOST_PHASES: f64 = 256.0;

/// A part of a row's plane, from z to z, of voxels of some edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) z: [f64; 2],
    pub(crate) edge: f64,
    pub(crate) cells: usize,
}

/// The parts in which some leaves lie, `speed` voxels to a metre of depth.
pub(crate) fn parts(leaves: &[Leaf], speed: f64) -> impl Iterator<Item = Part> {
    let bottom = leaves.iter().fold(f64::MAX, |z, leaf| z.min(leaf.z[1]));
    let mut z = leaves.iter().fold(f64::MIN, |z, leaf| z.max(leaf.z[0]));
    std::iter::from_fn(move || {
        while z > bottom {
            let Some((edge, to)) = next_part(leaves, z, CELLS as f64 * WIDEST[0] / speed) else {
                z = leaves.iter().filter(|leaf| leaf.z[0] < z).fold(f64::MIN, |z, leaf| z.max(leaf.z[0]));
                continue;
            };
            let to = to.max(bottom);
            let cells = ((z - to) * speed / (edge * WIDEST[0])).ceil().max(1.0) as usize;
            let part = Part { z: [z, to], edge, cells };
            z = to;
            return Some(part);
        }
        None
    })
}

/// Columns per pixel where pixels are so many finest voxels wide, at a part's front and back.
pub(crate) fn phases_of(widths: [f64; 2], edge: f64, spacing: usize) -> usize {
    let voxels = widths[0].max(widths[1]) / edge;
    let closer = f64::from(1 << spacing);
    (voxels * closer / WIDEST[1]).ceil().clamp(1.0, MOST_PHASES) as usize
}

/// The voxel's edge by which the part from z on is spaced, the coarsest that no leaf in it is finer than; and where it ends,
/// that many times `depth` away. None where no leaf is.
fn next_part(leaves: &[Leaf], z: f64, depth: f64) -> Option<(f64, f64)> {
    let mut edges: Vec<f64> = leaves.iter().map(|leaf| leaf.edge).collect();
    edges.sort_by(|a, b| b.total_cmp(a));
    edges.dedup();
    let meets = |to: f64| leaves.iter().filter(move |leaf| leaf.z[0] > to && leaf.z[1] < z);
    let end = |edge: f64| z - edge * depth;
    meets(end(*edges.last()?)).next()?;
    edges
        .into_iter()
        .map(|edge| (edge, end(edge)))
        .find(|&(edge, to)| meets(to).all(|leaf| leaf.edge >= edge))
}
