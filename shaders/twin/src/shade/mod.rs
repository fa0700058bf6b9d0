//! What a segment's colour becomes under the light.

mod any;
mod exaggerated;
mod law;
mod phong;
mod plain;
mod unsharp;

pub use any::AnyShade;
pub use law::Lit;
pub use phong::Phong;
pub use plain::Plain;

use super::gradient::Gradients;
use super::{Casting, Real, ray::Ray, real::Number, vector::Vec3};
use needs::Needs;

/// A module for the shading slot.
pub trait Shade {
    /// How much the shaded colour may vary within a step, for the estimate of a step's error.
    fn spread(needs: &Needs) -> f64;
    /// Steps may grow while the optical depth of one stays below this.
    fn safe_depth(needs: &Needs) -> f64;
    /// Whether it looks at gradients.
    fn reads_gradients(needs: &Needs) -> bool;

    /// The light on a segment of `material`: ambient, diffuse, specular, shininess.
    fn lighting<F: Real>(
        casting: &Casting<F>,
        gradients: &Gradients<F>,
        ray: &Ray<F>,
        material: [F; 4],
    ) -> Lighting<F>;
}

/// A shading that looks at one gradient alone, of one ray or of eight side by side.
pub trait Local: Shade {
    /// The light on a gradient of the scalar, on a segment of `material`.
    fn light<F: Number>(lit: &Lit<F>, gradient: Vec3<F>, material: [F; 4]) -> Lighting<F>;
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
}
