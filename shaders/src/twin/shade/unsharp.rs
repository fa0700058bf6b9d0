//! Normal unsharp masking: the gradient's difference from a coarser level's is added to it.

use super::Lighting;
use super::law::lit_by;
use crate::twin::gradient::{Gradients, LEAST_SQUARE};
use crate::twin::{Real, Scene, ray::Ray};

/// See `wgsl/shade/unsharp.wgsl`.
#[inline(always)]
pub(super) fn lighting<F: Real>(
    scene: &Scene<F>,
    gradients: &Gradients<F>,
    ray: &Ray<F>,
    material: [F; 4],
) -> Lighting<F> {
    let gradient = gradients.at + (gradients.at - gradients.coarse) * scene.view.detail;
    let square = gradient.dot(gradient);
    if square < F::of(LEAST_SQUARE) {
        return Lighting::NONE;
    }
    let lit = gradient.dot(scene.view.toward_light).abs() / square.sqrt();
    lit_by(scene, (gradient, square), lit, ray, material)
}
