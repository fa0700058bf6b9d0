//! No shading: a segment shows its own colour.

use super::{Lighting, Shade};
use crate::twin::{Real, View, ray::Ray, scene::BRICK_VOXELS, vector::Vec3};

/// Twin of `wgsl/shade/plain.wgsl`.
pub struct Plain;

impl Shade for Plain {
    const SPREAD: f64 = 0.0;
    const SAFE_DEPTH: f64 = 0.04;

    #[inline(always)]
    fn lighting<F: Real>(_: &View<F>, _: &[u16; BRICK_VOXELS], _: Vec3<F>, _: F, _: &Ray<F>) -> Lighting<F> {
        Lighting::NONE
    }
}
