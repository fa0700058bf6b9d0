//! Gradient shading as the law has it.

use super::law::Lit;
use super::{Lighting, Local, Shade};
use crate::gradient::{Gradients, LEAST_SQUARE};
use crate::real::Number;
use crate::vector::Vec3;
use crate::{Casting, Real, ray::Ray};
use needs::Needs;

/// Twin of `wgsl/shade/phong.wgsl`.
pub struct Phong;

impl Shade for Phong {
    #[inline(always)]
    fn spread(_: &Needs) -> f64 {
        0.1
    }

    #[inline(always)]
    fn safe_depth(_: &Needs) -> f64 {
        0.01
    }

    #[inline(always)]
    fn reads_gradients(_: &Needs) -> bool {
        true
    }

    #[inline(always)]
    fn lighting<F: Real>(
        casting: &Casting<F>,
        gradients: &Gradients<F>,
        ray: &Ray<F>,
        material: [F; 4],
    ) -> Lighting<F> {
        Self::light(&Lit::new(casting.scene, ray.direction_in_display), gradients.at, material)
    }
}

impl Local for Phong {
    #[inline(always)]
    fn light<F: Number>(lit: &Lit<F>, gradient: Vec3<F>, material: [F; 4]) -> Lighting<F> {
        let square = gradient.dot(gradient);
        let least = square.alike(LEAST_SQUARE);
        let none = Lighting { body: square.alike(1.0), highlight: square.alike(0.0) };
        if square.is_below(least) {
            return none;
        }
        let scattered = gradient.dot(lit.toward_light).abs() / square.sqrt();
        let light = lit.by((gradient, square), scattered, material);
        Lighting {
            body: square.choose(least, none.body, light.body),
            highlight: square.choose(least, none.highlight, light.highlight),
        }
    }
}
