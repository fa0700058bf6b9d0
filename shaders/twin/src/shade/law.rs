//! The shading law: two-sided Phong, weighted by the strength of the gradient.

use super::Lighting;
use crate::real::Number;
use crate::{Real, SceneNumbers, vector::Vec3};

/// What the law knows of a scene and of a ray, or of eight rays side by side.
#[derive(Clone, Copy)]
pub struct Lit<F> {
    /// Toward the light, display frame.
    pub toward_light: Vec3<F>,
    /// Square of the gradient at which shading has half its strength.
    pub half_square: F,
    /// Where the ray goes, display frame.
    pub direction: Vec3<F>,
}

impl<F: Real> Lit<F> {
    /// Of one ray.
    #[inline(always)]
    pub fn new(scene: &SceneNumbers<F>, direction: Vec3<F>) -> Self {
        Self { toward_light: scene.toward_light, half_square: scene.gradient_half_square, direction }
    }
}

impl<F: Number> Lit<F> {
    /// The light on a gradient of length sqrt(square) > 0, of which the share `lit` is scattered.
    #[inline(always)]
    pub(super) fn by(&self, (gradient, square): (Vec3<F>, F), lit: F, material: [F; 4]) -> Lighting<F> {
        let weight = square / (square + self.half_square);
        let [ambient, diffuse, specular, shininess] = material;
        let highlight = self.highlight(gradient, square.sqrt(), shininess);
        Lighting {
            body: weight.alike(1.0) - weight + weight * (ambient + diffuse * lit),
            highlight: weight * specular * highlight,
        }
    }

    /// |n·h|^shininess, 0 if h has no direction.
    #[inline(always)]
    fn highlight(&self, gradient: Vec3<F>, length: F, shininess: F) -> F {
        let halfway = self.toward_light - self.direction;
        let square = halfway.dot(halfway);
        let (zero, one) = (square.alike(0.0), square.alike(1.0));
        let cosine = (gradient.dot(halfway).abs() / length / square.sqrt()).least(one);
        let cosine = square.alike(1e-12).choose(square, cosine, zero);
        zero.choose(cosine, cosine.powf(shininess), zero)
    }
}
