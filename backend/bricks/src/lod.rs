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
