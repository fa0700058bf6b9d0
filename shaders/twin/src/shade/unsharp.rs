//! Normal unsharp masking: the gradient's difference from a coarser level's is added to it.

use super::Lighting;
use super::law::Lit;
use crate::gradient::{Gradients, LEAST_SQUARE};
use crate::{Casting, Real, ray::Ray};

/// See `wgsl/shade/unsharp.wgsl`.
#[inline(always)]
pub(super) fn lighting<F: Real>(
    casting: &Casting<F>,
    gradients: &Gradients<F>,
    ray: &Ray<F>,
    material: [F; 4],
) -> Lighting<F> {
    let gradient = gradients.at + (gradients.at - gradients.coarse) * casting.scene.detail;
    let square = gradient.dot(gradient);
    if square < F::of(LEAST_SQUARE) {
        return Lighting::NONE;
    }
    let lit = gradient.dot(casting.scene.toward_light).abs() / square.sqrt();
    Lit::new(casting.scene, ray.direction_in_display).by((gradient, square), lit, material)
}
