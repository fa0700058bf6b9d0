//! How closely row planes would have to sample what a frame shows, estimated from some of its bricks.

use bricks::{BRICK_EDGE, Brick, BrickSource, NodeKey, OctreeShape, is_shown};
use display_config::Display;
use optics::Optics;
use protocol::FrameState;
use std::collections::HashMap;

/// Ways down to bricks that are looked at.
const BRICKS: u64 = 64;
/// Every so many lines of samples of a brick, along each axis.
const LINES: usize = 4;
/// The odd number next to 2⁶⁴ over the golden ratio: its multiples spread evenly.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Samples that row planes take per voxel of the volume, as of the latest optics.
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
    /// For a frame. It depends on the volume and the frame alone, so that all back-ends find the same; a brick that
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
    let mut known: HashMap<NodeKey, f64> = HashMap::new();
    let mut sum = 0.0;
    for number in 0..BRICKS {
        let Some((node, share)) = wander(source, seen, number) else { continue };
        let level = source.shape().level(node.depth);
        let look = || source.brick(node).map_or(0.0, |brick| samples_per_voxel(&brick, level, seen));
        sum += share * *known.entry(node).or_insert_with(look);
    }
    sum / BRICKS as f64
}

/// A node that shows something and is as fine as is asked for, another one for most numbers; and the share of the volume that may
/// show something, as the way there tells. Nodes are met as often as they are large: so what is found there, times the share, is
/// what is found in all of the volume, on average. None where nothing shows on the way.
fn wander(source: &dyn BrickSource, seen: &Seen, number: u64) -> Option<(NodeKey, f64)> {
    let shape = source.shape();
    let size = |node: NodeKey| {
        let (low, high) = shape.region(node);
        (high - low).element_product()
    };
    let (mut node, mut share) = (NodeKey::ROOT, 1.0);
    let mut choice = (number + 1).wrapping_mul(SPREAD);
    while node.depth < seen.depth {
        let (mut all, mut shown) = (0.0, Vec::new());
        for child in (0..8).map(|octant| node.child(octant)).filter(|&child| shape.contains(child)) {
            all += size(child);
            if is_shown(&seen.optics, source.summary(child)) {
                shown.push(child);
            }
        }
        let visible: f64 = shown.iter().copied().map(size).sum();
        share *= visible / all;
        let mut left = visible * (choice >> 32) as f64 / f64::from(u32::MAX);
        let is_met = |&child: &NodeKey| {
            left -= size(child);
            left <= 0.0
        };
        node = shown.iter().copied().find(is_met).or(shown.last().copied())?;
        choice = choice.wrapping_mul(SPREAD) ^ (choice >> 29);
    }
    Some((node, share))
}

/// Samples that planes would take of a voxel of a brick, on average: none where neither of two neighbours shows. What the middle
/// of two voxels shows is off from the mean of both by as much as planes with samples a voxel apart err.
fn samples_per_voxel(brick: &Brick, level: u8, seen: &Seen) -> f64 {
    let (optics, voxel_m) = (&seen.optics, seen.voxel_m());
    let per_voxel = optics.extinction_per_metre(voxel_m) * voxel_m * f64::from(1u32 << level);
    let depth = |scalar: f64| optics.extinction.at(scalar) * per_voxel;
    let (mut samples, mut voxels) = (0, 0u32);
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
                    }
                    voxels += 1;
                }
            }
        }
    }
    samples as f64 / f64::from(voxels)
}

#[cfg(test)]
mod tests {
    use super::super::test_scene::{display, frame};
    use super::*;
    use bricks::procedural::ProceduralVolume;
    use glam::{DAffine3, UVec3};
    use optics::Curve;

    /// The estimate of shells with some extinction, turned by an angle.
    fn closeness(extinction: Vec<(f64, f64)>, angle: f64) -> f64 {
        let source = ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap();
        let mut frame = frame(0.4);
        frame.optics.extinction = Curve::new(extinction).unwrap();
        frame.display_from_volume = DAffine3::from_rotation_y(angle) * frame.display_from_volume;
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
        let [thin, soft, steep] = [0.01, 0.1, 50.0].map(|depth| closeness(rising(depth), 0.0));
        assert!(0.0 < thin && thin < 1.0, "{thin}: what shows of it has a sample a voxel");
        assert!(thin <= soft && soft < 2.0 * thin && 10.0 * soft < steep, "{thin} {soft} {steep}");
        assert_eq!(closeness(vec![(0.0, 0.0)], 0.0), 0.0, "nothing shows");
    }

    #[test]
    fn it_does_not_depend_on_how_the_volume_is_turned() {
        for angle in [0.1, 1.0, 2.5] {
            assert_eq!(closeness(rising(5.0), angle), closeness(rising(5.0), 0.0));
        }
    }

    #[test]
    fn ways_down_meet_what_shows_as_often_as_it_is_large() {
        // Its last bricks along x are a ninth as wide as others.
        let source = ProceduralVolume::new("shells", UVec3::new(115, 56, 56), 1e-3).unwrap();
        let mut frame = frame(0.0);
        frame.optics.extinction = Curve::constant(1.0);
        let seen = Seen::of(&source.shape(), &display(), &frame);
        let ways: Vec<(NodeKey, f64)> =
            (0..1000).filter_map(|number| wander(&source, &seen, number)).collect();
        assert!(ways.len() == 1000 && ways.iter().all(|&(_, share)| share == 1.0));
        let narrow = ways.iter().filter(|(node, _)| node.cell.x == 4).count();
        assert!((10..50).contains(&narrow), "{narrow} for 26");
    }
}
