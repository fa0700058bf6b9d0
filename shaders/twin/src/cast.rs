//! Rays from pixels to their colours.

use super::composite::{Consistent, Mimda, Over, Paper};
use super::debug::debug_pixel;
use super::kernel::{Blended, Enhanced, Full, Lean};
use super::shade::{AnyShade, Phong, Plain};
use super::way::{RAYS, cast_packet, cast_ray};
use super::{Cast, Casting, ProjectorRays, Real, ray::Ray};
use lanes::Simd;
use needs::{Chain, Compositing, Levels, Needs, Shading, Way};
use optics::MimdaForm;

/// The twin of a frame and a shading, with the compositing that the scene needs.
macro_rules! composited {
    ($frame:ident, $shade:ident, $casting:ident, $ray:ident) => {
        match $casting.needs.compositing {
            Compositing::Over => cast_ray::<F, $frame<$shade, Over<false>>>($casting, &$ray),
            Compositing::Mimda(MimdaForm::Paper) => {
                cast_ray::<F, $frame<$shade, Mimda<Paper>>>($casting, &$ray)
            }
            Compositing::Mimda(MimdaForm::Consistent) => {
                cast_ray::<F, $frame<$shade, Mimda<Consistent>>>($casting, &$ray)
            }
        }
    };
}

/// The same for rays side by side.
macro_rules! in_packets {
    ($frame:ident, $shade:ident, $simd:ident, $casting:ident, $rays:ident, $casts:ident) => {
        for rays in $rays.chunks(RAYS) {
            match $casting.needs.compositing {
                Compositing::Over => {
                    cast_packet::<S, $frame<$shade, Over<false>>>($simd, $casting, rays, $casts)
                }
                Compositing::Mimda(MimdaForm::Paper) => {
                    cast_packet::<S, $frame<$shade, Mimda<Paper>>>($simd, $casting, rays, $casts)
                }
                Compositing::Mimda(MimdaForm::Consistent) => {
                    cast_packet::<S, $frame<$shade, Mimda<Consistent>>>($simd, $casting, rays, $casts)
                }
            }
        }
    };
}

/// The same with enhancers, of those compositings that [`Frame::of`] lets through.
macro_rules! enhanced {
    ($shade:ident, $simd:ident, $casting:ident, $rays:ident, $casts:ident) => {
        for rays in $rays.chunks(RAYS) {
            match $casting.needs.compositing {
                Compositing::Over => {
                    cast_packet::<S, Enhanced<$shade, Over<false>>>($simd, $casting, rays, $casts)
                }
                Compositing::Mimda(_) => {
                    cast_packet::<S, Enhanced<$shade, Mimda<Consistent>>>($simd, $casting, rays, $casts)
                }
            }
        }
    };
}

/// The ray of a projector's pixel (x, y).
#[inline(always)]
pub(super) fn ray_of_pixel<F: Real>(casting: &Casting<F>, rays: &ProjectorRays<F>, x: u32, y: u32) -> Ray<F> {
    let half = F::of(0.5);
    Ray::of_pixel(casting.scene, rays, F::of_u32(x) + half, F::of_u32(y) + half)
}

/// Casts rays with the modules that a kernel for the scene's needs has: side by side with those that have lanes.
#[inline(always)]
pub(super) fn cast_leanly<S: Simd>(
    simd: S,
    casting: &Casting<f32>,
    rays: &[Ray<f32>],
    casts: &mut Vec<Cast<f32>>,
) {
    let needs = casting.needs;
    let is_plain = needs.shading == Shading::Plain;
    match (Frame::of(needs), is_plain) {
        (Frame::Lean, true) => in_packets!(Lean, Plain, simd, casting, rays, casts),
        (Frame::Lean, false) => in_packets!(Lean, Phong, simd, casting, rays, casts),
        (Frame::Blended, true) => in_packets!(Blended, Plain, simd, casting, rays, casts),
        (Frame::Blended, false) => in_packets!(Blended, Phong, simd, casting, rays, casts),
        (Frame::Enhanced, true) => enhanced!(Plain, simd, casting, rays, casts),
        (Frame::Enhanced, false) => enhanced!(Phong, simd, casting, rays, casts),
        (Frame::Full, _) => {
            for &ray in rays {
                casts.push(cast_with_all(casting, ray));
            }
        }
    }
}

/// Casts the ray of a projector's pixel (x, y) with a twin that has every module.
#[inline(always)]
pub fn cast_in_full<F: Real>(casting: &Casting<F>, rays: &ProjectorRays<F>, x: u32, y: u32) -> Cast<F> {
    as_shown(casting, cast_with_all(casting, ray_of_pixel(casting, rays, x, y)))
}

/// A pixel's cast with the colour that it has in the picture.
#[inline(always)]
pub(super) fn as_shown<F: Real>(casting: &Casting<F>, cast: Cast<F>) -> Cast<F> {
    Cast { rgba: debug_pixel(casting, cast.rgba, cast.samples), ..cast }
}

/// Casts a ray with every module: it sees the same as with those alone that it needs, only later.
#[inline(always)]
pub(super) fn cast_with_all<F: Real>(casting: &Casting<F>, ray: Ray<F>) -> Cast<F> {
    if casting.needs.tells_importance {
        cast_ray::<F, Full<AnyShade, Over<true>>>(casting, &ray)
    } else {
        composited!(Full, AnyShade, casting, ray)
    }
}

/// The twin with the fewest features that has all that a scene needs, shading and compositing apart.
enum Frame {
    Lean,
    Blended,
    Enhanced,
    Full,
}

impl Frame {
    fn of(needs: &Needs) -> Self {
        let Needs { levels, blends, spreads, shading, has_materials, compositing, way, chain, debug, .. } =
            *needs;
        let is_rare = levels != Levels::Single
            || shading.has_detail()
            || has_materials
            || way != Way::Straight
            || debug.is_some()
            // A twin takes seconds to compile: enhancers have one of their own with the common ways to composite.
            || needs.tells_importance
            || (chain != Chain::EMPTY && compositing == Compositing::Mimda(MimdaForm::Paper));
        match (is_rare, chain == Chain::EMPTY, blends || spreads) {
            (true, ..) => Self::Full,
            (false, false, _) => Self::Enhanced,
            (false, true, true) => Self::Blended,
            (false, true, false) => Self::Lean,
        }
    }
}
