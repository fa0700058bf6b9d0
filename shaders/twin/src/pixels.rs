//! The twin in f32, compiled once, here: there are many of it, and each takes seconds.

use super::cast::{as_shown, cast_leanly, ray_of_pixel};
use super::{Cast, Casting, ProjectorRays, ShortRay, ray::Ray};

/// Casts the rays of some pixels (x, y).
pub fn cast_pixels(
    casting: &Casting<f32>,
    rays: &ProjectorRays<f32>,
    pixels: &[(u32, u32)],
) -> Vec<Cast<f32>> {
    let rays: Vec<Ray<f32>> = pixels.iter().map(|&(x, y)| ray_of_pixel(casting, rays, x, y)).collect();
    let mut casts = cast_rays(casting, &rays);
    casts.iter_mut().for_each(|cast| *cast = as_shown(casting, *cast));
    casts
}

/// Casts short rays of a projector. What a debug view shows of a whole ray does not count for a part of it: its colours are those
/// of the scene.
pub fn cast_short(casting: &Casting<f32>, rays: &ProjectorRays<f32>, short: &[ShortRay]) -> Vec<Cast<f32>> {
    let ray = |&ShortRay { pixel, end_m }: &ShortRay| {
        let [x, y] = [pixel % rays.raster[0], pixel / rays.raster[0]];
        ray_of_pixel(casting, rays, x, y).until(end_m)
    };
    cast_rays(casting, &short.iter().map(ray).collect::<Vec<_>>())
}

/// AVX2 changes no result, as nothing is contracted or reordered. Processors without it (before 2013) have no twins of their own for
/// lean scenes, which would take as long again to compile.
fn cast_rays(casting: &Casting<f32>, rays: &[Ray<f32>]) -> Vec<Cast<f32>> {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has just been asked for AVX2.
            return unsafe { cast_with_avx2(casting, rays) };
        }
        rays.iter().map(|&ray| super::cast::cast_with_all(casting, ray)).collect()
    }
    #[cfg(not(target_arch = "x86_64"))]
    cast_one_by_one(casting, rays)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn cast_with_avx2(casting: &Casting<f32>, rays: &[Ray<f32>]) -> Vec<Cast<f32>> {
    cast_one_by_one(casting, rays)
}

#[inline(always)]
fn cast_one_by_one(casting: &Casting<f32>, rays: &[Ray<f32>]) -> Vec<Cast<f32>> {
    let mut casts = Vec::with_capacity(rays.len());
    // Not a closure: it would be compiled without the wider instructions of the function that this is inlined into.
    for &ray in rays {
        casts.push(cast_leanly(casting, ray));
    }
    casts
}
