//! The shading law: two-sided Phong, weighted by the strength of the gradient.

use super::Lighting;
use crate::{Casting, Real, ray::Ray, vector::Vec3};

/// The light on a gradient of length sqrt(square) > 0, of which the share `lit` is scattered.
#[inline(always)]
pub(super) fn lit_by<F: Real>(
    casting: &Casting<F>,
    (gradient, square): (Vec3<F>, F),
    lit: F,
    ray: &Ray<F>,
    material: [F; 4],
) -> Lighting<F> {
    let scene = casting.scene;
    let weight = square / (square + scene.gradient_half_square);
    let [ambient, diffuse, specular, shininess] = material;
    let halfway = scene.toward_light - ray.direction_in_display;
    let highlight = highlight(gradient, square.sqrt(), halfway, shininess);
    Lighting {
        body: F::ONE - weight + weight * (ambient + diffuse * lit),
        highlight: weight * specular * highlight,
    }
}

/// |n·h|^shininess, 0 if h has no direction.
#[inline(always)]
fn highlight<F: Real>(gradient: Vec3<F>, length: F, halfway: Vec3<F>, shininess: F) -> F {
    let square = halfway.dot(halfway);
    if square > F::of(1e-12) {
        let cosine = (gradient.dot(halfway).abs() / length / square.sqrt()).least(F::ONE);
        if cosine > F::ZERO {
            return cosine.powf(shininess);
        }
    }
    F::ZERO
}
