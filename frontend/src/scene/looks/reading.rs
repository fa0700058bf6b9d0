//! Reads enough of a volume's values to tell what it is.

use super::Values;
use super::values::{Pair, Sample};
use crate::scene::VolumeFacts;
use bricks::{Brick, BrickSource, NodeKey, OVERLAP, OWN_EDGE, OctreeShape};
use glam::{UVec3, uvec3};
use rayon::prelude::*;

/// Bricks that are read for the distribution of values, at most: a level that has more is too fine.
const MOST_BRICKS: u64 = 512;
/// Bricks of which every voxel counts; of more of them, every other one along each axis does.
const WHOLE_BRICKS: u64 = 64;
/// Bricks of the finest level that are looked at, where that level has too many: there, labels are not blended.
const FINE_BRICKS: usize = 32;

/// What its file tells of a volume, and its values, from its finest level that has few bricks, and from some bricks of the finest one. What cannot be
/// read does not count.
pub fn read_values(volume: &dyn BrickSource) -> Values {
    let shape = volume.shape();
    let finest = shape.finest_depth();
    let depth = (0..=finest).rev().find(|&depth| shape.node_count(depth) <= MOST_BRICKS).unwrap_or(0);
    let stride = if shape.node_count(depth) <= WHOLE_BRICKS { 1 } else { 2 };
    let coarse = sample(volume, &shape.nodes(depth).collect::<Vec<_>>(), stride);
    let fine = (depth < finest).then(|| sample(volume, &some_of(volume, &shape), 1));
    let edge = f64::from(1_u32 << shape.level(depth));
    let values = Values::new(&coarse, fine.as_ref(), edge, VolumeFacts::of(volume).value_range);
    values.of_modality(volume.modality())
}

/// Bricks of the finest level that are not of one value, from all over it. Only those are met that are looked at: a file may
/// claim more than anybody could count.
fn some_of(volume: &dyn BrickSource, shape: &OctreeShape) -> Vec<NodeKey> {
    let depth = shape.finest_depth();
    let bricks = shape.node_count(depth);
    let step = (bricks / (8 * FINE_BRICKS as u64)).max(1);
    let varies = |node: &NodeKey| {
        let summary = volume.summary(*node);
        summary.min < summary.max
    };
    let looked_at = (0..bricks.div_ceil(step)).map(|place| shape.node(depth, place * step));
    let nodes: Vec<_> = looked_at.filter(varies).collect();
    let every = nodes.len().div_ceil(FINE_BRICKS).max(1);
    nodes.into_iter().step_by(every).collect()
}

fn sample(volume: &dyn BrickSource, nodes: &[NodeKey], stride: usize) -> Sample {
    let shape = volume.shape();
    let parts = nodes.par_iter().filter_map(|&node| {
        let brick = volume.brick(node).ok()?;
        Some(of_brick(&brick, own_voxels(&shape, node), stride))
    });
    parts.reduce(Sample::default, Sample::with)
}

/// Voxels of the level that are the node's own, along each axis.
fn own_voxels(shape: &OctreeShape, node: NodeKey) -> UVec3 {
    let own = OWN_EDGE as u32;
    (shape.level_dims(node.depth) - node.cell * own).min(UVec3::splat(own))
}

fn of_brick(brick: &Brick, own: UVec3, stride: usize) -> Sample {
    let mut sample = Sample::default();
    let value = |voxel: UVec3| {
        let [i, j, k] = voxel.to_array().map(|i| i as usize + OVERLAP);
        brick.value(Brick::index(i, j, k)) as f32
    };
    for z in (0..own.z).step_by(stride) {
        for y in (0..own.y).step_by(stride) {
            for x in (0..own.x).step_by(stride) {
                let here = value(uvec3(x, y, z));
                sample.values.push(here);
                if x + 1 < own.x {
                    sample.pairs.push(Pair { here, beside: value(uvec3(x + 1, y, z)) });
                }
            }
        }
    }
    sample
}

#[cfg(test)]
mod tests {
    use super::*;
    use bricks::volume::{MAX_EDGE_VOXELS, VolumeFrame};
    use bricks::{BRICK_VOXELS, BrickError, Codes, NodeSummary};
    use glam::DVec3;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// A volume as large as can be, which counts what is asked of it.
    struct Endless(AtomicU64);

    impl BrickSource for Endless {
        fn shape(&self) -> OctreeShape {
            OctreeShape::new(UVec3::splat(MAX_EDGE_VOXELS))
        }

        fn frame(&self) -> VolumeFrame {
            VolumeFrame::of_voxels(DVec3::splat(1e-3))
        }

        fn value_range(&self) -> (f64, f64) {
            (0.0, 255.0)
        }

        fn summary(&self, _: NodeKey) -> NodeSummary {
            self.0.fetch_add(1, Ordering::Relaxed);
            NodeSummary { min: 0.0, max: 255.0 }
        }

        fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
            assert!(self.shape().contains(node), "{node:?}");
            Ok(Brick::new(Codes::U8(vec![7; BRICK_VOXELS]), 0.0, 1.0))
        }
    }

    #[test]
    fn no_claim_of_bricks_makes_it_count_them() {
        let volume = Endless(AtomicU64::new(0));
        read_values(&volume);
        let asked = volume.0.load(Ordering::Relaxed);
        assert!((1..=16 * FINE_BRICKS as u64).contains(&asked), "{asked}");
    }
}
