//! How closely row planes would have to sample what a frame shows, estimated from some of its bricks.

use bricks::{BRICK_EDGE, Brick, BrickSource, NodeKey, OctreeShape, is_shown};
use display_config::Display;
use optics::Optics;
use protocol::FrameState;
use std::collections::HashSet;

/// Bricks that are looked at, at most.
const BRICKS: u64 = 64;
/// Every so many lines of samples of a brick, along each axis.
const LINES: usize = 4;
/// The odd number next to 2⁶⁴ over the golden ratio: its multiples spread evenly.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Samples on a row's plane per voxel that shows, as of the latest optics.
#[derive(Debug, Default)]
pub(super) struct Closeness {
    latest: Option<(Seen, f64)>,
}

/// What they depend on: nothing that moves, so that a volume can be turned without asking again, and frames find the same in any
/// order.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    optics: Optics,
    tolerance: f64,
    /// Eighths of octaves of a finest voxel's edge over a metre.
    scale: i32,
    /// The depth of bricks that are fine enough for the screen plane.
    depth: u8,
}

impl Seen {
    fn of(shape: &OctreeShape, display: &Display, frame: &FrameState) -> Self {
        let scale = (8.0 * frame.voxel_m().log2()).round() as i32;
        let mut seen =
            Self { optics: frame.optics.clone(), tolerance: frame.quality.tolerance, scale, depth: 0 };
        let levels = (frame.quality.lod_scale * display.pixel_size_m / seen.voxel_m()).log2().floor();
        let finest = shape.finest_depth();
        seen.depth = finest - levels.clamp(0.0, f64::from(finest)) as u8;
        seen
    }

    /// Edge of a finest voxel, metres.
    fn voxel_m(&self) -> f64 {
        (f64::from(self.scale) / 8.0).exp2()
    }
}

impl Closeness {
    /// For a frame: at least 1. It depends on the volume and the frame alone, so that all back-ends find the same; a brick that
    /// cannot be read counts for nothing.
    pub(super) fn of(&mut self, source: &dyn BrickSource, display: &Display, frame: &FrameState) -> f64 {
        let seen = Seen::of(&source.shape(), display, frame);
        if let Some((latest, closeness)) = &self.latest
            && *latest == seen
        {
            return *closeness;
        }
        let closeness = estimate(source, &seen);
        self.latest = Some((seen, closeness));
        closeness
    }
}

fn estimate(source: &dyn BrickSource, seen: &Seen) -> f64 {
    let nodes: HashSet<NodeKey> = (0..BRICKS).filter_map(|number| wander(source, seen, number)).collect();
    let (mut samples, mut voxels) = (0, 0);
    for node in nodes {
        let Ok(brick) = source.brick(node) else { continue };
        let found = samples_and_voxels(&brick, source.shape().level(node.depth), seen);
        (samples, voxels) = (samples + found.0, voxels + found.1);
    }
    samples.max(1) as f64 / voxels.max(1) as f64
}

/// A node that shows something and is as fine as is asked for, another one for most numbers. None where the way down ends before.
fn wander(source: &dyn BrickSource, seen: &Seen, number: u64) -> Option<NodeKey> {
    let shape = source.shape();
    let mut node = NodeKey::ROOT;
    let mut choice = (number + 1).wrapping_mul(SPREAD);
    while node.depth < seen.depth {
        let children = (0..8).map(|octant| node.child(octant)).filter(|&child| shape.contains(child));
        let shown: Vec<NodeKey> =
            children.filter(|&child| is_shown(&seen.optics, source.summary(child))).collect();
        node = *shown.get((choice >> 32) as usize % shown.len().max(1))?;
        choice = choice.wrapping_mul(SPREAD) ^ choice >> 29;
    }
    Some(node)
}

/// Samples that planes would take of the voxels between neighbours of which one shows, and how many of these there are. What
/// the middle of two voxels shows is off from the mean of both by as much as planes with samples a voxel apart err.
fn samples_and_voxels(brick: &Brick, level: u8, seen: &Seen) -> (u64, u64) {
    let (optics, voxel_m) = (&seen.optics, seen.voxel_m());
    let per_voxel = optics.extinction_per_metre(voxel_m) * voxel_m * f64::from(1u32 << level);
    let depth = |scalar: f64| optics.extinction.at(scalar) * per_voxel;
    let (mut samples, mut voxels) = (0, 0);
    for axis in 0..3 {
        let mut step = [0; 3];
        step[axis] = 1;
        let further = Brick::index(step[0], step[1], step[2]);
        for j in (0..BRICK_EDGE).step_by(LINES) {
            for k in (0..BRICK_EDGE).step_by(LINES) {
                let start = [[0, j, k], [j, 0, k], [j, k, 0]][axis];
                let start = Brick::index(start[0], start[1], start[2]);
                let scalar = |i: usize| optics.normalise(brick.value(start + i * further));
                let mut here = (scalar(0), depth(scalar(0)));
                for i in 1..BRICK_EDGE {
                    let before = here;
                    here = (scalar(i), depth(scalar(i)));
                    if before.1 > 0.0 || here.1 > 0.0 {
                        let middle = depth(0.5 * (before.0 + here.0));
                        let error = (middle - 0.5 * (before.1 + here.1)).abs();
                        samples += planes::samples_per_voxel(error as f32, seen.tolerance as f32);
                        voxels += 1;
                    }
                }
            }
        }
    }
    (samples, voxels)
}

#[cfg(test)]
mod tests {
    use super::super::test_scene::{display, frame};
    use super::*;
    use bricks::procedural::ProceduralVolume;
    use glam::{DAffine3, DVec3, UVec3};
    use optics::Curve;

    /// The estimate of shells with some extinction, at a size and turned by an angle.
    fn closeness(extinction: Vec<(f64, f64)>, size: f64, angle: f64) -> f64 {
        let source = ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap();
        let mut frame = frame(0.4);
        frame.optics.extinction = Curve::new(extinction).unwrap();
        frame.display_from_volume = DAffine3::from_rotation_y(angle)
            * DAffine3::from_scale(DVec3::splat(size))
            * frame.display_from_volume;
        Closeness::default().of(&source, &display(), &frame)
    }

    /// What shows from 0.4 on, and within a tenth of the domain has some optical depth a voxel.
    fn rising(depth: f64) -> Vec<(f64, f64)> {
        let frame = frame(0.4);
        let per_voxel = 1.0 / (frame.voxel_m() * frame.optics.extinction_per_metre(frame.voxel_m()));
        vec![(0.4, 0.0), (0.5, depth * per_voxel), (1.0, depth * per_voxel)]
    }

    #[test]
    fn thin_fog_needs_a_sample_a_voxel_and_steep_surfaces_need_more() {
        assert_eq!(closeness(rising(0.01), 1.0, 0.0), 1.0);
        let (soft, steep) = (closeness(rising(0.5), 1.0, 0.0), closeness(rising(50.0), 1.0, 0.0));
        assert!(1.0 < soft && soft < 2.0 && steep > 2.0 * soft, "{soft} {steep}");
        assert_eq!(closeness(vec![(0.0, 0.0)], 1.0, 0.0), 1.0, "nothing shows");
    }

    #[test]
    fn it_does_not_depend_on_how_the_volume_is_turned() {
        for angle in [0.1, 1.0, 2.5] {
            assert_eq!(closeness(rising(5.0), 1.0, angle), closeness(rising(5.0), 1.0, 0.0));
        }
        assert_ne!(
            closeness(rising(5.0), 0.2, 0.0),
            closeness(rising(5.0), 1.0, 0.0),
            "smaller ones have thinner voxels"
        );
    }
}
