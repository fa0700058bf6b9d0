//! How fine a node must be: the display's resolution at its depth.

use crate::{NodeKey, OWN_EDGE, OctreeShape};
use display_config::{Display, Resolution, longest_voxel_edge_m};
use glam::{DAffine3, DVec3};

/// The level of detail a picture asks for. It depends on where a node floats, never on the viewer: so every
/// projector of every back-end converges to the same cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodRule {
    /// Volume frame (finest voxels) to display frame (metres).
    pub display_from_volume: DAffine3,
    /// s0: pixel size on the screen, metres.
    pub pixel_size_m: f64,
    /// Φ: the display's angular accuracy, radians.
    pub angular_accuracy: f64,
    /// See [`optics::Quality::lod_scale`]; 0 asks for the finest level everywhere.
    pub lod_scale: f64,
}

impl LodRule {
    /// The rule for a volume placed in a display, at a [`lod_scale`](optics::Quality::lod_scale).
    pub fn new(display: &Display, display_from_volume: DAffine3, lod_scale: f64) -> Self {
        Self {
            display_from_volume,
            pixel_size_m: display.pixel_size_m,
            angular_accuracy: display.angular_accuracy,
            lod_scale,
        }
    }

    /// How many levels too coarse `node` is: log2(voxel edge / (lod_scale · s(z))) with s(z) = s0 + 2 |z| tan(Φ/2) at
    /// the |z| of the node's region nearest to the screen, and the longest voxel edge. At or below 0 it is fine
    /// enough. +∞ where the finest level is asked for.
    ///
    /// If lod_scale · s(z) rises with |z| faster than a restricted cut can follow, its slope is limited: see
    /// [`LodRule::steepest`].
    pub fn deficit(&self, shape: &OctreeShape, node: NodeKey) -> f64 {
        self.measured().deficit(shape, node)
    }

    /// The rule, ready to be asked of many nodes.
    pub fn measured(&self) -> MeasuredRule {
        let slope = self.lod_scale * self.resolution().slope();
        MeasuredRule {
            row: self.display_from_volume.matrix3.row(2),
            offset_m: self.display_from_volume.translation.z,
            finest_voxel_m: longest_voxel_edge_m(&self.display_from_volume),
            wanted_at_screen_m: self.lod_scale * self.pixel_size_m,
            slope: slope.min(self.steepest()),
        }
    }

    /// The steepest slope of the wanted voxel edge over |z| at which touching leaves of the cut differ by one level at
    /// most: a node of voxel edge V reaches over at most 28 V g along z, with g the sum of the voxel axes' parts along z
    /// over the longest voxel edge, and on this way V may not double.
    ///
    /// Proof. Let a leaf of voxel edge 4 V' or more, fine enough, touch a leaf of V', whose parent (2 V') is not. At the
    /// point where they touch 4 V' is wanted or more; on the way to the parent's point nearest to the screen this falls
    /// by 2 V' at most. So the parent is fine enough, too.
    pub fn steepest(&self) -> f64 {
        let linear = self.display_from_volume.matrix3;
        let along_z = linear.x_axis.z.abs() + linear.y_axis.z.abs() + linear.z_axis.z.abs();
        longest_voxel_edge_m(&self.display_from_volume) / (OWN_EDGE as f64 * along_z)
    }

    /// Whether the same depth is wanted everywhere in the volume: then there are no borders between levels to see.
    pub fn is_uniform(&self, shape: &OctreeShape) -> bool {
        let measured = self.measured();
        let (nearest, farthest) = measured.depths_m(shape, NodeKey::ROOT);
        let wanted = |z_m: f64| {
            let level = (measured.wanted_m(z_m) / measured.finest_voxel_m).log2();
            level.floor().clamp(0.0, f64::from(shape.finest_depth()))
        };
        wanted(nearest) == wanted(farthest)
    }

    /// What the display resolves.
    pub fn resolution(&self) -> Resolution {
        Resolution { pixel_size_m: self.pixel_size_m, angular_accuracy: self.angular_accuracy }
    }

    /// Whether a ray may take its samples from `node`: it is at the finest level or fine enough.
    pub fn is_fine_enough(&self, shape: &OctreeShape, node: NodeKey) -> bool {
        node.depth == shape.finest_depth() || self.deficit(shape, node) <= 0.0
    }
}

/// A [`LodRule`] whose numbers are worked out.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredRule {
    /// z in the display frame of a point p of the volume frame is `row · p + offset_m`.
    row: DVec3,
    offset_m: f64,
    finest_voxel_m: f64,
    wanted_at_screen_m: f64,
    slope: f64,
}

impl MeasuredRule {
    /// See [`LodRule::deficit`].
    pub fn deficit(&self, shape: &OctreeShape, node: NodeKey) -> f64 {
        let voxel_m = self.finest_voxel_m * f64::from(1u32 << shape.level(node.depth));
        (voxel_m / self.wanted_m(self.depths_m(shape, node).0)).log2()
    }

    /// The longest voxel edge that is fine enough at |z|, metres.
    fn wanted_m(&self, z_m: f64) -> f64 {
        self.wanted_at_screen_m + self.slope * z_m
    }

    /// The least and the largest distance between the screen plane and the node's region, metres; the least is 0 if
    /// the screen cuts it.
    fn depths_m(&self, shape: &OctreeShape, node: NodeKey) -> (f64, f64) {
        let (low, high) = shape.region(node);
        let (a, b) = (self.row * low, self.row * high);
        let back = self.offset_m + a.min(b).element_sum();
        let front = self.offset_m + a.max(b).element_sum();
        let nearest = if back <= 0.0 && front >= 0.0 { 0.0 } else { back.abs().min(front.abs()) };
        (nearest, back.abs().max(front.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, UVec3};
    use proptest::prelude::*;
    use std::collections::HashSet;

    /// The inner nodes of the cut that a rule asks for.
    fn inner_nodes(rule: &MeasuredRule, shape: &OctreeShape) -> HashSet<NodeKey> {
        let splits = |key: &NodeKey| key.depth < shape.finest_depth() && rule.deficit(shape, *key) > 0.0;
        let (mut inner, mut open) = (HashSet::new(), vec![NodeKey::ROOT]);
        while let Some(key) = open.pop() {
            if splits(&key) {
                inner.insert(key);
                open.extend((0..8).map(|octant| key.child(octant)).filter(|&child| shape.contains(child)));
            }
        }
        inner
    }

    /// The rule without a limit: what the display resolves, and no more.
    fn unlimited(rule: &LodRule) -> MeasuredRule {
        MeasuredRule { slope: rule.lod_scale * rule.resolution().slope(), ..rule.measured() }
    }

    /// Splits leaves that touch what is two levels finer, until there are none.
    fn restricted(mut inner: HashSet<NodeKey>, shape: &OctreeShape) -> HashSet<NodeKey> {
        loop {
            let mut forced = HashSet::new();
            for key in inner.iter().filter(|key| key.depth > 0) {
                for offset in (0..27).map(|i| glam::IVec3::new(i % 3, i / 3 % 3, i / 9) - 1) {
                    let cell = key.cell.as_ivec3() + offset;
                    let touching = NodeKey { depth: key.depth, cell: cell.max(glam::IVec3::ZERO).as_uvec3() };
                    if cell.min_element() >= 0 && shape.contains(touching) {
                        forced.extend(touching.parent().filter(|parent| !inner.contains(parent)));
                    }
                }
            }
            if forced.is_empty() {
                return inner;
            }
            inner.extend(forced);
        }
    }

    prop_compose! {
        /// A rule that asks for anything from the finest level to the root within a volume.
        fn rules()(
            turn in prop::array::uniform4(-1.0..1.0_f64), z in -0.6..0.6_f64, stretch in 0.3..1.0_f64,
            pixel in 0.3..4.0_f64, slope in 0.0..1.0_f64,
        ) -> LodRule {
            let turn = DQuat::from_array(turn);
            let turn = if turn.length() > 0.1 { turn.normalize() } else { DQuat::IDENTITY };
            let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, z)) * DAffine3::from_quat(turn);
            LodRule {
                display_from_volume: place * DAffine3::from_scale(1e-3 * DVec3::new(1.0, 1.0, stretch)),
                pixel_size_m: 1e-3 * pixel,
                angular_accuracy: slope,
                lod_scale: 1.0,
            }
        }
    }

    proptest! {
        /// No two touching leaves are more than one level apart, and nothing is coarser than the display resolves.
        #[test]
        fn the_cut_is_restricted(rule in rules(), dims in prop::array::uniform3(1..330_u32)) {
            let shape = OctreeShape::new(UVec3::from_array(dims));
            let inner = inner_nodes(&rule.measured(), &shape);
            prop_assert_eq!(&restricted(inner.clone(), &shape), &inner);
            prop_assert!(inner_nodes(&unlimited(&rule), &shape).is_subset(&inner));
        }
    }

    /// The canary.
    #[test]
    fn without_a_limit_to_the_slope_the_cut_is_not_restricted() {
        let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.09));
        let rule = LodRule {
            display_from_volume: place * DAffine3::from_scale(DVec3::splat(1e-3)),
            pixel_size_m: 1e-3,
            angular_accuracy: 0.5,
            lod_scale: 1.0,
        };
        let shape = OctreeShape::new(UVec3::splat(28 * 16));
        let inner = inner_nodes(&unlimited(&rule), &shape);
        assert!(restricted(inner.clone(), &shape).len() > inner.len());
    }
}
