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
    /// Steps may grow while the optical depth of one stays below this.
    const SAFE_DEPTH: f64;

    /// The light at `place`, in texels of the brick; `gradient_scale` turns a difference over two texels into a change
    /// of the scalar per finest voxel.
    fn lighting<F: Real>(
        view: &View<F>,
        brick: &[u16; BRICK_VOXELS],
        place: Vec3<F>,
        gradient_scale: F,
        ray: &Ray<F>,
    ) -> Lighting<F>;
}

/// What light makes of a colour: τ c · body + τ · highlight.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<F> {
    /// Factor of the colour.
    pub body: F,
    /// White light added.
    pub highlight: F,
}

impl<F: Real> Lighting<F> {
    /// Plain colours.
    pub const NONE: Self = Self { body: F::ONE, highlight: F::ZERO };

    /// Lit τ c of a mean of (τ c, τ).
    #[inline(always)]
    pub fn on(self, k: [F; 4]) -> Vec3<F> {
        Vec3([k[0], k[1], k[2]]) * self.body + Vec3::splat(k[3] * self.highlight)
    }
}
