//! No shading: a segment shows its own colour.

use super::Shade;
use crate::twin::{Real, View, ray::Ray, scene::BRICK_VOXELS, vector::Vec3};

/// Twin of `wgsl/shade/plain.wgsl`.
pub struct Plain;

impl Shade for Plain {
    const SPREAD: f64 = 0.0;

    #[inline(always)]
    fn shade<F: Real>(
        _: &View<F>,
        _: &[u16; BRICK_VOXELS],
        k: [F; 4],
        _: Vec3<F>,
        _: F,
        _: &Ray<F>,
    ) -> Vec3<F> {
        Vec3([k[0], k[1], k[2]])
    }
}
