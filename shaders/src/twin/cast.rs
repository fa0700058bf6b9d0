//! One ray from a pixel to its colour.

use super::composite::{MimdaConsistent, MimdaPaper, Over};
use super::debug::debug_pixel;
use super::kernel::{Blended, Full, Lean};
use super::shade::{AnyShade, Phong, Plain};
use super::way::cast_ray;
use super::{Casting, ProjectorRays, Real, ray::Ray};
use crate::compose::{Chain, Compositing, Levels, Needs, Shading, Way};
use optics::MimdaForm;

/// What one ray brings back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast<F> {
    /// Premultiplied linear RGB and opacity.
    pub rgba: [F; 4],
    /// Samples of the volume, gradients not counted.
    pub samples: u32,
    /// Whether a node on the way was too coarse.
    pub is_missing: bool,
}

/// Casts the ray of a projector's pixel (x, y) with the modules that a kernel for the scene's needs has.
#[inline(always)]
pub fn cast_pixel<F: Real>(casting: &Casting<F>, rays: &ProjectorRays<F>, x: u32, y: u32) -> Cast<F> {
    let half = F::of(0.5);
    let ray = Ray::of_pixel(casting.scene, rays, F::of_u32(x) + half, F::of_u32(y) + half);
    let is_lean = is_lean(casting.needs);
    if is_lean && casting.needs.blends && casting.needs.compositing == Compositing::Over {
        return match casting.needs.shading {
            Shading::Plain => cast_ray::<F, Blended<Plain, Over>>(casting, &ray),
            _ => cast_ray::<F, Blended<Phong, Over>>(casting, &ray),
        };
    }
    if is_lean && !casting.needs.blends {
        let is_plain = casting.needs.shading == Shading::Plain;
        return match (is_plain, casting.needs.compositing) {
            (true, Compositing::Over) => cast_ray::<F, Lean<Plain, Over>>(casting, &ray),
            (false, Compositing::Over) => cast_ray::<F, Lean<Phong, Over>>(casting, &ray),
            (true, Compositing::Mimda(MimdaForm::Paper)) => {
                cast_ray::<F, Lean<Plain, MimdaPaper>>(casting, &ray)
            }
            (false, Compositing::Mimda(MimdaForm::Paper)) => {
                cast_ray::<F, Lean<Phong, MimdaPaper>>(casting, &ray)
            }
            (true, Compositing::Mimda(MimdaForm::Consistent)) => {
                cast_ray::<F, Lean<Plain, MimdaConsistent>>(casting, &ray)
            }
            (false, Compositing::Mimda(MimdaForm::Consistent)) => {
                cast_ray::<F, Lean<Phong, MimdaConsistent>>(casting, &ray)
            }
        };
    }
    let cast = match casting.needs.compositing {
        Compositing::Over => cast_ray::<F, Full<AnyShade, Over>>(casting, &ray),
        Compositing::Mimda(MimdaForm::Paper) => cast_ray::<F, Full<AnyShade, MimdaPaper>>(casting, &ray),
        Compositing::Mimda(MimdaForm::Consistent) => {
            cast_ray::<F, Full<AnyShade, MimdaConsistent>>(casting, &ray)
        }
    };
    Cast { rgba: debug_pixel(casting, cast.rgba, cast.samples), ..cast }
}

/// Whether shading, compositing and blending are all that a scene needs.
fn is_lean(needs: &Needs) -> bool {
    let Needs { levels, blends: _, shading, has_materials, compositing: _, way, chain, debug } = *needs;
    levels == Levels::Single
        && !shading.has_detail()
        && !has_materials
        && way == Way::Straight
        && chain == Chain::EMPTY
        && debug.is_none()
}
