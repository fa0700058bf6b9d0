//! One ray from a pixel to its colour.

use super::composite::{Consistent, Mimda, Over, Paper};
use super::debug::debug_pixel;
use super::kernel::{Blended, Full, Lean};
use super::shade::{AnyShade, Phong, Plain};
use super::way::cast_ray;
use super::{Cast, Casting, ProjectorRays, Real, ray::Ray};
use crate::needs::{Chain, Compositing, Levels, Needs, Shading, Way};
use optics::MimdaForm;

/// Casts the ray of a projector's pixel (x, y) with the modules that a kernel for the scene's needs has.
#[inline(always)]
pub fn cast_pixel<F: Real>(casting: &Casting<F>, rays: &ProjectorRays<F>, x: u32, y: u32) -> Cast<F> {
    let half = F::of(0.5);
    let ray = Ray::of_pixel(casting.scene, rays, F::of_u32(x) + half, F::of_u32(y) + half);
    let needs = casting.needs;
    /// The twin of a frame and a shading, with the compositing that the scene needs.
    macro_rules! composited {
        ($frame:ident, $shade:ident) => {
            match needs.compositing {
                Compositing::Over => cast_ray::<F, $frame<$shade, Over>>(casting, &ray),
                Compositing::Mimda(MimdaForm::Paper) => {
                    cast_ray::<F, $frame<$shade, Mimda<Paper>>>(casting, &ray)
                }
                Compositing::Mimda(MimdaForm::Consistent) => {
                    cast_ray::<F, $frame<$shade, Mimda<Consistent>>>(casting, &ray)
                }
            }
        };
    }
    let is_plain = needs.shading == Shading::Plain;
    match (is_lean(needs), needs.blends || needs.spreads, is_plain) {
        (true, false, true) => composited!(Lean, Plain),
        (true, false, false) => composited!(Lean, Phong),
        (true, true, true) if needs.compositing == Compositing::Over => {
            cast_ray::<F, Blended<Plain, Over>>(casting, &ray)
        }
        (true, true, false) if needs.compositing == Compositing::Over => {
            cast_ray::<F, Blended<Phong, Over>>(casting, &ray)
        }
        _ => {
            let cast = composited!(Full, AnyShade);
            Cast { rgba: debug_pixel(casting, cast.rgba, cast.samples), ..cast }
        }
    }
}

/// Whether shading, compositing, blending and spreads are all that a scene needs.
fn is_lean(needs: &Needs) -> bool {
    let Needs { levels, blends: _, spreads: _, shading, has_materials, compositing: _, way, chain, debug } =
        *needs;
    levels == Levels::Single
        && !shading.has_detail()
        && !has_materials
        && way == Way::Straight
        && chain == Chain::EMPTY
        && debug.is_none()
}
