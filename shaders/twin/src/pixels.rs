//! The twin in f32, compiled once, here: there are many of it, and each takes seconds.

#[cfg(target_arch = "x86_64")]
use super::cast::cast_with_all;
use super::cast::{as_shown, cast_leanly, ray_of_pixel};
use super::{Cast, Casting, ProjectorRays, ShortRay, ray::Ray};
use lanes::*;

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

/// Lanes change no result, as nothing is contracted or reordered. Processors without AVX2 (before 2013) have no twins of their own
/// for lean scenes, which would take as long again to compile.
fn cast_rays(casting: &Casting<f32>, rays: &[Ray<f32>]) -> Vec<Cast<f32>> {
    let mut casts = Vec::with_capacity(rays.len());
    #[cfg(target_arch = "x86_64")]
    match Level::new().as_avx2() {
        Some(simd) => simd.vectorize(
            #[inline(always)]
            || cast_leanly(simd, casting, rays, &mut casts),
        ),
        None => casts.extend(rays.iter().map(|&ray| cast_with_all(casting, ray))),
    }
    #[cfg(not(target_arch = "x86_64"))]
    dispatch!(Level::new(), simd => cast_leanly(simd, casting, rays, &mut casts));
    casts
}
