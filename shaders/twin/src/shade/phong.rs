//! Gradient shading as the law has it.

use super::law::lit_by;
use super::{Lighting, Shade};
use crate::gradient::{Gradients, LEAST_SQUARE};
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
        let square = gradients.at.dot(gradients.at);
        if square < F::of(LEAST_SQUARE) {
            return Lighting::NONE;
        }
        let lit = gradients.at.dot(casting.scene.toward_light).abs() / square.sqrt();
        lit_by(casting, (gradients.at, square), lit, ray, material)
    }
}
