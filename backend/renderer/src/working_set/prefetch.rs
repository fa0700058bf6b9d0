//! Prefetching along the motion: the nodes that a picture will ask for soon.

use bricks::LodRule;
use bricks::{NodeKey, OctreeShape};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::time::Duration;

/// How far ahead motion is followed when the disk is idle.
pub const HORIZON: Duration = Duration::from_millis(500);
/// Bricks fetched ahead at a time.
pub const MOST_AHEAD: usize = 128;
/// Below this, a predicted scale is held: it falls linearly and must not pass zero. What shrinks asks for nothing finer.
const LEAST_SCALE: f64 = 0.01;

/// How the volume moves, by the rules of two frames.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// The rule of this frame.
    pub now: &'a LodRule,
    /// The rule of the frame before.
    pub before: &'a LodRule,
    /// The time between the two.
    pub between: Duration,
}

impl Motion<'_> {
    /// The rule as it will be after a while, if the motion goes on as it is.
    ///
    /// The motion in the display frame, `now · before⁻¹`, is taken as a turn and a growth about the volume's centre and
    /// a way of the centre. With k = `ahead` over the time between the frames: the turn's axis stays and its angle
    /// becomes k-fold (its logarithm goes on linearly); of the scale factor r, 1 + k (r − 1) is left; the centre goes on
    /// along a straight line. So the shape of the voxels plays no part, and a volume that turns on the spot stays there.
    ///
    /// Where nothing changed, no time went by, or a frame's transform has no inverse, nothing moves.
    pub fn rule_after(&self, ahead: Duration, shape: &OctreeShape) -> LodRule {
        let (now, before) = (self.now.display_from_volume, self.before.display_from_volume);
        if now == before {
            return *self.now;
        }
        let k = ahead.as_secs_f64() / self.between.as_secs_f64();
        let predicted = extrapolate(before, now, k, 0.5 * shape.dims().as_dvec3());
        let is_sound = predicted.is_finite() && predicted.matrix3.determinant() != 0.0;
        LodRule { display_from_volume: if is_sound { predicted } else { now }, ..*self.now }
    }
}

/// The children of leaves that are fine enough now and will not be at the end of `horizon`: those whose time comes
/// first go first (by the deficit, taken to rise linearly until then), at most `most` of them. Only nodes for which
/// `is_shown`, which is asked for nodes inside the volume alone, are listed. The order depends on nothing else.
pub fn prefetch(
    leaves: impl IntoIterator<Item = NodeKey>,
    motion: &Motion,
    horizon: Duration,
    shape: &OctreeShape,
    is_shown: impl Fn(NodeKey) -> bool,
    most: usize,
) -> Vec<NodeKey> {
    let soon = motion.rule_after(horizon, shape);
    if soon == *motion.now {
        return Vec::new();
    }
    let when = |leaf: NodeKey| {
        let will_want = motion.now.is_fine_enough(shape, leaf) && !soon.is_fine_enough(shape, leaf);
        let (now, then) = (motion.now.deficit(shape, leaf), soon.deficit(shape, leaf));
        // The part of the horizon after which the deficit is zero.
        will_want.then(|| (now / (now - then), leaf))
    };
    let mut coarse: Vec<(f64, NodeKey)> = leaves.into_iter().filter_map(when).collect();
    coarse.sort_by(|(a, key_a), (b, key_b)| a.total_cmp(b).then_with(|| key_a.cmp(key_b)));
    let children = coarse.iter().flat_map(|(_, leaf)| (0..8).map(|octant| leaf.child(octant)));
    children.filter(|&child| shape.contains(child) && is_shown(child)).take(most).collect()
}

/// Where a transform will be `k` times the step from `before` to `now` later; `centre` is in the volume frame.
fn extrapolate(before: DAffine3, now: DAffine3, k: f64, centre: DVec3) -> DAffine3 {
    let step = now.matrix3 * before.matrix3.inverse();
    let scale = step.determinant().cbrt();
    let (axis, angle) = DQuat::from_mat3(&step.mul_scalar(scale.recip())).normalize().to_axis_angle();
    // The shorter way around.
    let angle = if angle > std::f64::consts::PI { angle - std::f64::consts::TAU } else { angle };
    let grown = (1.0 + k * (scale - 1.0)).max(LEAST_SCALE);
    let linear = DMat3::from_axis_angle(axis, k * angle).mul_scalar(grown) * now.matrix3;
    let (was, is) = (before.transform_point3(centre), now.transform_point3(centre));
    DAffine3::from_mat3_translation(linear, is + k * (is - was) - linear * centre)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec3;
    use std::collections::BTreeSet;

    /// 1792³ voxels of unequal edges, 7 levels.
    fn shape() -> OctreeShape {
        OctreeShape::new(UVec3::splat(28 * 64))
    }

    /// A pose of the volume: its centre stands `z` metres in front of the screen.
    fn pose(turn: f64, scale: f64, z: f64) -> DAffine3 {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        let linear = DMat3::from_axis_angle(axis, turn).mul_scalar(scale * 1e-4)
            * DMat3::from_diagonal(DVec3::new(1.0, 0.9, 1.2));
        let centre = DVec3::new(0.02, -0.01, z);
        DAffine3::from_mat3_translation(linear, centre - linear * (0.5 * shape().dims().as_dvec3()))
    }

    fn rule(display_from_volume: DAffine3) -> LodRule {
        LodRule { display_from_volume, pixel_size_m: 1e-4, angular_accuracy: 0.002, lod_scale: 1.0 }
    }

    /// The leaves of the cut that a rule asks for.
    fn leaves(rule: &LodRule) -> Vec<NodeKey> {
        let shape = shape();
        let (mut found, mut rest) = (Vec::new(), vec![NodeKey::ROOT]);
        while let Some(node) = rest.pop() {
            match rule.is_fine_enough(&shape, node) {
                true => found.push(node),
                false => rest.extend((0..8).map(|o| node.child(o)).filter(|&child| shape.contains(child))),
            }
        }
        found
    }

    fn ahead(before: DAffine3, now: DAffine3, most: usize) -> Vec<NodeKey> {
        let (before, now) = (rule(before), rule(now));
        let motion = Motion { now: &now, before: &before, between: Duration::from_millis(20) };
        prefetch(leaves(&now), &motion, Duration::from_millis(200), &shape(), |_| true, most)
    }

    #[test]
    fn without_motion_nothing_is_listed() {
        let still = rule(pose(0.3, 1.0, 0.4));
        assert_eq!(ahead(still.display_from_volume, still.display_from_volume, 1000), []);
        let other = rule(pose(0.3, 1.0, 0.5));
        let at_once = Motion { now: &still, before: &other, between: Duration::ZERO };
        assert_eq!(prefetch(leaves(&still), &at_once, Duration::from_secs(1), &shape(), |_| true, 1000), []);
        let flat = LodRule { display_from_volume: DAffine3::from_scale(DVec3::ZERO), ..still };
        let from_nothing = Motion { now: &still, before: &flat, between: Duration::from_secs(1) };
        assert_eq!(
            prefetch(leaves(&still), &from_nothing, Duration::from_secs(1), &shape(), |_| true, 1000),
            []
        );
    }

    /// At twenty times the step, against the pose that the motion leads to.
    #[test]
    fn a_motion_goes_on_as_it_is() {
        for (turn, growth, way) in
            [(0.01, 0.0, 0.0), (0.0, 0.003, 0.0), (0.0, 0.0, -0.004), (-0.04, 0.01, 0.01)]
        {
            let at = |step: f64| pose(0.2 + step * turn, 1.0 + step * growth, 0.3 + step * way);
            let (before, now) = (rule(at(-1.0)), rule(at(0.0)));
            let motion = Motion { now: &now, before: &before, between: Duration::from_millis(16) };
            let found = motion.rule_after(Duration::from_millis(320), &shape()).display_from_volume;
            // The growth of a step is relative to the scale before it.
            let scale = 1.0 + 20.0 * growth / (1.0 - growth);
            let expected = pose(0.2 + 20.0 * turn, scale, 0.3 + 20.0 * way);
            assert!(found.abs_diff_eq(expected, 1e-9), "{found} {expected}");
        }
    }

    /// A mirrored volume moves as its twin does.
    #[test]
    fn a_mirrored_volume_turns_the_same_way() {
        let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let centre = DVec3::splat(7.0);
        let mirrored = centre * DVec3::new(-1.0, 1.0, 1.0);
        let whole = extrapolate(pose(0.1, 1.0, 0.2), pose(0.2, 1.1, 0.3), 5.0, centre);
        let found = extrapolate(pose(0.1, 1.0, 0.2) * mirror, pose(0.2, 1.1, 0.3) * mirror, 5.0, mirrored);
        assert!(found.abs_diff_eq(whole * mirror, 1e-12));
    }

    /// What is listed on an approach is what the frame at that time asks for beyond what this one does.
    #[test]
    fn an_approach_lists_what_becomes_too_coarse() {
        let at = |step: f64| pose(0.2, 1.0, 0.5 - 0.005 * step);
        let listed = ahead(at(-1.0), at(0.0), usize::MAX);
        let (now, then) = (rule(at(0.0)), rule(at(10.0)));
        let coarse = leaves(&now).into_iter().filter(|&leaf| !then.is_fine_enough(&shape(), leaf));
        let expected: BTreeSet<NodeKey> =
            coarse.flat_map(|leaf| (0..8).map(move |o| leaf.child(o))).collect();
        assert!(expected.len() > 50 && 8 * leaves(&now).len() > expected.len(), "{}", expected.len());
        assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), expected);
        assert_eq!(listed.len(), expected.len());
        // On the way back none of them is.
        assert_eq!(ahead(at(1.0), at(0.0), usize::MAX), []);
    }

    #[test]
    fn the_first_to_become_too_coarse_comes_first() {
        let at = |step: f64| pose(0.2, 1.0, 0.5 - 0.005 * step);
        let listed = ahead(at(-1.0), at(0.0), usize::MAX);
        assert_eq!(ahead(at(-1.0), at(0.0), 11), listed[..11]);
        // At a third of the way the first third or so is too coarse, and the rest is not.
        let third = rule(at(10.0 / 3.0));
        let is_coarse = |child: &NodeKey| !third.is_fine_enough(&shape(), child.parent().unwrap());
        let is_coarse: Vec<bool> = listed.iter().map(is_coarse).collect();
        let count = is_coarse.iter().filter(|&&is| is).count();
        assert!(count > 0 && count < listed.len(), "{count} of {}", listed.len());
        let misplaced = is_coarse[..count].iter().filter(|&&is| !is).count();
        assert!(10 * misplaced <= count, "{misplaced} of {count}");
    }

    #[test]
    fn the_order_of_the_leaves_plays_no_part_and_hidden_nodes_have_none() {
        let (before, now) = (rule(pose(0.2, 1.0, 0.52)), rule(pose(0.25, 1.0, 0.5)));
        let motion = Motion { now: &now, before: &before, between: Duration::from_millis(20) };
        let is_shown = |key: NodeKey| key.cell.x.is_multiple_of(2);
        let mut cut = leaves(&now);
        let list = |cut: &[NodeKey]| {
            prefetch(cut.iter().copied(), &motion, Duration::from_millis(200), &shape(), is_shown, 500)
        };
        let listed = list(&cut);
        cut.reverse();
        assert_eq!(list(&cut), listed);
        cut.sort();
        assert_eq!(list(&cut), listed);
        assert!(!listed.is_empty() && listed.iter().all(|&key| is_shown(key)));
    }
}
