//! No shading: a segment shows its own colour.

use super::law::Lit;
use super::{Lighting, Local, Shade};
use crate::gradient::Gradients;
use crate::real::Number;
use crate::vector::Vec3;
use crate::{Casting, Real, ray::Ray};
use needs::Needs;

/// Twin of `wgsl/shade/plain.wgsl`.
pub struct Plain;

impl Shade for Plain {
    #[inline(always)]
    fn spread(_: &Needs) -> f64 {
        0.0
    }

    #[inline(always)]
    fn safe_depth(_: &Needs) -> f64 {
        0.04
    }

    #[inline(always)]
    fn reads_gradients(_: &Needs) -> bool {
        false
    }

    #[inline(always)]
    fn lighting<F: Real>(_: &Casting<F>, _: &Gradients<F>, _: &Ray<F>, _: [F; 4]) -> Lighting<F> {
        Lighting::NONE
    }
}

impl Local for Plain {
    #[inline(always)]
    fn light<F: Number>(lit: &Lit<F>, _: Vec3<F>, _: [F; 4]) -> Lighting<F> {
        Lighting { body: lit.half_square.alike(1.0), highlight: lit.half_square.alike(0.0) }
    }
}
