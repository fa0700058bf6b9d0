//! One level of detail around a ray: where a brick's samples lie on it.

use crate::sample::{sample_brick, sample_deviations};
use crate::traverse::{node_low, voxel_edge};
use crate::{Casting, Real, ray::Ray, vector::Vec3};
use layout::{NodeRecord, brick};

/// See `Level` in `wgsl/levels/level.wgsl`.
#[derive(Clone, Copy)]
pub struct Level<'a, F> {
    /// The brick's samples.
    pub codes: &'a [u16; brick::VOXELS],
    pub(crate) base: Vec3<F>,
    /// Texels per metre of t.
    pub slope: Vec3<F>,
    /// Turns a difference over two texels into a change of the scalar per finest voxel.
    pub gradient_scale: F,
    offset: F,
    scale: F,
    /// The standard deviations, and that of code 255; None where samples stand for themselves.
    pub deviations: Option<(&'a [u8; brick::VOXELS], F)>,
}

impl<'a, F: Real> Level<'a, F> {
    /// Texels of overlap on each side of a brick.
    pub(super) const OVERLAP: f64 = brick::OVERLAP as f64;

    /// Of a node with a brick.
    #[inline(always)]
    pub fn new(casting: &Casting<'a, F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let finest = casting.scene.finest_depth;
        let edge = voxel_edge::<F>(finest, node.depth);
        let overlap = F::of(Self::OVERLAP);
        let scale = F::of_f32(node.scale);
        Self {
            codes: casting.volume.brick(node.slot),
            base: (ray.origin_in_volume - node_low(finest, node)).map(|c| c / edge + overlap),
            slope: ray.direction_in_volume.map(|c| c / edge),
            gradient_scale: F::of(0.5) * scale / edge,
            offset: F::of_f32(node.offset),
            scale,
            deviations: (node.deviation_scale > 0.0)
                .then(|| (casting.volume.deviations(node.slot), F::of_f32(node.deviation_scale))),
        }
    }

    /// The point at t, in texels.
    #[inline(always)]
    pub fn point(&self, t: F) -> Vec3<F> {
        self.base + self.slope * t
    }

    /// The standard deviation at t of what samples stand for.
    #[inline(always)]
    pub(crate) fn spread(&self, t: F) -> F {
        self.deviations.map_or(F::ZERO, |(codes, scale)| scale * sample_deviations(codes, self.point(t)))
    }

    /// The scalar of the lowest code, and what the highest adds to it.
    #[inline(always)]
    pub fn code_range(&self) -> [F; 2] {
        [self.offset, self.scale]
    }

    /// The scalar at t, not held to [0, 1].
    #[inline(always)]
    pub fn scalar(&self, t: F) -> F {
        self.offset + self.scale * sample_brick(self.codes, self.point(t))
    }
}
