//! The kernels' twin in either precision: in f64, where it shows what rounding costs, with every module for every scene.

use twin::{Cast, Casting, ProjectorRays, Real, cast_in_full};

/// A number that a whole twin is compiled for.
pub trait Precision: Real {
    /// Casts the rays of some pixels (x, y): with every module, but where there are twins for less.
    fn cast_pixels(
        casting: &Casting<Self>,
        rays: &ProjectorRays<Self>,
        pixels: &[(u32, u32)],
    ) -> Vec<Cast<Self>> {
        pixels.iter().map(|&(x, y)| cast_in_full(casting, rays, x, y)).collect()
    }
}

impl Precision for f32 {
    fn cast_pixels(
        casting: &Casting<Self>,
        rays: &ProjectorRays<Self>,
        pixels: &[(u32, u32)],
    ) -> Vec<Cast<Self>> {
        twin::cast_pixels(casting, rays, pixels)
    }
}

impl Precision for f64 {}
