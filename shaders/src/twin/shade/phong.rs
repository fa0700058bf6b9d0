//! Gradient shading: two-sided Phong, weighted by the strength of the gradient.

use super::{Lighting, Shade};
use crate::twin::{Real, View, ray::Ray, sample::differences, scene::BRICK_VOXELS, vector::Vec3};

/// Twin of `wgsl/shade/phong.wgsl`.
pub struct Phong;

impl Shade for Phong {
    const SPREAD: f64 = 0.1;
    const SAFE_DEPTH: f64 = 0.01;

    #[inline(always)]
    fn lighting<F: Real>(
        view: &View<F>,
        brick: &[u16; BRICK_VOXELS],
        place: Vec3<F>,
        gradient_scale: F,
        ray: &Ray<F>,
    ) -> Lighting<F> {
        let difference = differences(brick, place);
        let in_volume = difference * gradient_scale;
        let m = &view.volume_from_display;
        let gradient = Vec3([m[0].dot(in_volume), m[1].dot(in_volume), m[2].dot(in_volume)]) * view.voxel_m;
        let square = gradient.dot(gradient);
        if square < F::of(1e-30) {
            return Lighting::NONE;
        }
        let weight = square / (square + view.gradient_half_square);
        let length = square.sqrt();
        let normal = gradient.map(|c| c / length);
        let [ambient, diffuse, specular, shininess] = view.material;
        let lit = normal.dot(view.toward_light).abs();
        let highlight = highlight(normal, view.toward_light - ray.direction_in_display, shininess);
        Lighting {
            body: F::ONE - weight + weight * (ambient + diffuse * lit),
            highlight: weight * specular * highlight,
        }
    }
}

/// |n·h|^shininess, 0 where h has no direction.
#[inline(always)]
fn highlight<F: Real>(normal: Vec3<F>, halfway: Vec3<F>, shininess: F) -> F {
    let square = halfway.dot(halfway);
    if square > F::of(1e-12) {
        let cosine = (normal.dot(halfway).abs() / square.sqrt()).least(F::ONE);
        if cosine > F::ZERO {
            return cosine.powf(shininess);
        }
    }
    F::ZERO
}
