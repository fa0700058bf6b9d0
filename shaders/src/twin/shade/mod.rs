//! What a segment's colour becomes under the light.

mod phong;
mod plain;

pub use phong::Phong;
pub use plain::Plain;

use super::{Real, View, ray::Ray, scene::BRICK_VOXELS, vector::Vec3};

/// A module for the shading slot.
pub trait Shade {
    /// How much the shaded colour may vary within a step, for the estimate of a step's error.
    const SPREAD: f64;

    /// The shaded τ c of a segment: `k` is the mean of (τ c, τ), `middle` the segment's middle in texels of the brick,
    /// `gradient_scale` turns a difference over two texels into a change of the scalar per finest voxel.
    fn shade<F: Real>(
        view: &View<F>,
        brick: &[u16; BRICK_VOXELS],
        k: [F; 4],
        middle: Vec3<F>,
        gradient_scale: F,
        ray: &Ray<F>,
    ) -> Vec3<F>;
}
