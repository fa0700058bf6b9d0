//! Whichever shading a scene needs.

use super::{Lighting, Phong, Plain, Shade, exaggerated, unsharp};
use crate::gradient::Gradients;
use crate::{Casting, Real, ray::Ray};
use needs::{Needs, Shading};

/// Whichever shading a scene needs.
pub struct AnyShade;

impl Shade for AnyShade {
    #[inline(always)]
    fn spread(needs: &Needs) -> f64 {
        if Self::reads_gradients(needs) { Phong::spread(needs) } else { Plain::spread(needs) }
    }

    #[inline(always)]
    fn safe_depth(needs: &Needs) -> f64 {
        if Self::reads_gradients(needs) { Phong::safe_depth(needs) } else { Plain::safe_depth(needs) }
    }

    #[inline(always)]
    fn reads_gradients(needs: &Needs) -> bool {
        needs.shading != Shading::Plain
    }

    #[inline(always)]
    fn lighting<F: Real>(
        casting: &Casting<F>,
        gradients: &Gradients<F>,
        ray: &Ray<F>,
        material: [F; 4],
    ) -> Lighting<F> {
        match casting.needs.shading {
            Shading::Plain => Lighting::NONE,
            Shading::Phong => Phong::lighting(casting, gradients, ray, material),
            Shading::Unsharp => unsharp::lighting(casting, gradients, ray, material),
            Shading::Exaggerated => exaggerated::lighting(casting, gradients, ray, material),
        }
    }
}
