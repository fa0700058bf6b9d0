//! The twin in f32, compiled once, here: there are many of it, and each takes seconds.

use super::cast::{cast_in_full, cast_pixel};
use super::{Cast, Casting, ProjectorRays};

/// Casts the rays of some pixels (x, y). AVX2 changes no result, as nothing is contracted or reordered. Processors without it
/// (before 2013) have no twins of their own for lean scenes, which would take as long again to compile.
pub fn cast_pixels(
    casting: &Casting<f32>,
    rays: &ProjectorRays<f32>,
    pixels: &[(u32, u32)],
) -> Vec<Cast<f32>> {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has just been asked for AVX2.
            return unsafe { cast_with_avx2(casting, rays, pixels) };
        }
        pixels.iter().map(|&(x, y)| cast_in_full(casting, rays, x, y)).collect()
    }
    #[cfg(not(target_arch = "x86_64"))]
    cast_leanly(casting, rays, pixels)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn cast_with_avx2(
    casting: &Casting<f32>,
    rays: &ProjectorRays<f32>,
    pixels: &[(u32, u32)],
) -> Vec<Cast<f32>> {
    cast_leanly(casting, rays, pixels)
}

#[inline(always)]
fn cast_leanly(casting: &Casting<f32>, rays: &ProjectorRays<f32>, pixels: &[(u32, u32)]) -> Vec<Cast<f32>> {
    let mut casts = Vec::with_capacity(pixels.len());
    // Not a closure: it would be compiled without the wider instructions of the function that this is inlined into.
    for &(x, y) in pixels {
        casts.push(cast_pixel(casting, rays, x, y));
    }
    casts
}
