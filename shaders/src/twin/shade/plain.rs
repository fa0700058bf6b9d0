//! No shading: a segment shows its own colour.

use super::{Lighting, Shade};
use crate::twin::gradient::Gradients;
use crate::twin::{Real, Scene, ray::Ray};

/// Twin of `wgsl/shade/plain.wgsl`.
pub struct Plain;

impl Shade for Plain {
    const SPREAD: f64 = 0.0;
    const SAFE_DEPTH: f64 = 0.04;
    const READS_GRADIENTS: bool = false;

    #[inline(always)]
    fn lighting<F: Real>(_: &Scene<F>, _: &Gradients<F>, _: &Ray<F>, _: [F; 4]) -> Lighting<F> {
        Lighting::NONE
    }
}
