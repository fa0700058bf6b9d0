//! Exaggerated shading: each level is lit along the surface of the next coarser one.

use super::Lighting;
use super::law::Lit;
use crate::gradient::{Gradients, LEAST_SQUARE};
use crate::{Casting, Real, ray::Ray, vector::Vec3};

/// See `wgsl/shade/exaggerated.wgsl`.
#[inline(always)]
pub(super) fn lighting<F: Real>(
    casting: &Casting<F>,
    gradients: &Gradients<F>,
    ray: &Ray<F>,
    material: [F; 4],
) -> Lighting<F> {
    let square = gradients.at.dot(gradients.at);
    if square < F::of(LEAST_SQUARE) {
        return Lighting::NONE;
    }
    let light = casting.scene.toward_light;
    let [n0, n1, n2] = [gradients.at, gradients.coarse, gradients.coarsest].map(outward);
    let contrast = casting.scene.detail;
    let levels = F::of(0.5) * raked(n0, n1, light, contrast)
        + F::of(0.3) * raked(n1, n2, light, contrast)
        + F::of(0.2) * n2.dot(light);
    let half = F::of(0.5);
    let lit = (half + half * levels).most(F::ZERO).least(F::ONE);
    Lit::new(casting.scene, ray.direction_in_display).by((gradients.at, square), lit, material)
}

/// Unit vector toward lower values; zero if there is none.
#[inline(always)]
fn outward<F: Real>(gradient: Vec3<F>) -> Vec3<F> {
    let square = gradient.dot(gradient);
    if square < F::of(LEAST_SQUARE) {
        return Vec3::ZERO;
    }
    gradient * (-F::ONE / square.sqrt())
}

/// The light that rakes over the coarser surface, on the finer one.
#[inline(always)]
fn raked<F: Real>(fine: Vec3<F>, coarse: Vec3<F>, light: Vec3<F>, contrast: F) -> F {
    if coarse.dot(coarse) == F::ZERO {
        return F::ZERO;
    }
    let along = light - coarse * coarse.dot(light);
    let cosine = contrast * fine.dot(along) / (along.dot(along) + F::of(0.01)).sqrt();
    cosine.most(-F::ONE).least(F::ONE)
}
