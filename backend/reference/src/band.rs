//! An interval of the scalar on which every curve of an optical model is linear.

use super::Cubic;
use glam::{DVec3, DVec4};
use optics::{Curve, CurveValue, MOST_ENHANCERS, Material};

/// A function that is linear over a band: its value at the band's start, and its change over the band.
#[derive(Clone, Copy, Debug)]
pub struct Linear<V>(pub V, pub V);

/// An interval of the scalar on which every curve is linear. Positions in it are x = (s − start) / width.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    /// The scalar at its start.
    pub start: f64,
    /// Its width; 1 where it has none.
    pub width: f64,
    /// Extinction, 1/metre.
    pub extinction: Linear<f64>,
    /// Colour, linear RGB.
    pub colour: Linear<DVec3>,
    /// Importance as the chain leaves it; 0 where the medium has none.
    pub importance: Linear<f64>,
    /// Importance as the chain of enhancers takes it: the scene's own, 1 where it gives none or nothing looks at it.
    pub told: Linear<f64>,
    /// What each link of the chain has of the scalar: its own band's value, 0 for links without a band.
    pub shares: [Linear<f64>; MOST_ENHANCERS],
    /// Factors of the shading law, where they depend on the scalar.
    pub material: Option<Linear<DVec4>>,
}

impl Band {
    /// The place in the band of the scalar `s`.
    pub fn place(&self, s: f64) -> f64 {
        (s - self.start) / self.width
    }

    /// The place in the band along a way on which the scalar is a cubic.
    pub fn places(&self, scalar: &Cubic) -> Cubic {
        scalar.relative_to(self.start, self.width)
    }

    /// The importance at the scalar `s`.
    pub fn importance_at(&self, s: f64) -> f64 {
        (self.importance.0 + self.importance.1 * self.place(s)).clamp(0.0, 1.0)
    }

    /// The scalar at which the importance, which must change in this band, is `importance`.
    pub fn scalar_where(&self, importance: f64) -> f64 {
        self.start + self.width * ((importance - self.importance.0) / self.importance.1)
    }

    /// What the shading law takes at `place`: `light`'s factors where the scene has none per scalar.
    pub fn material(&self, place: f64, light: Material) -> Material {
        let Some(Linear(start, change)) = self.material else { return light };
        let [ambient, diffuse, specular, shininess] = (start + change * place).to_array();
        Material { ambient, diffuse, specular, shininess }
    }

    /// Whether nothing is visible anywhere in the band.
    pub fn is_empty(&self) -> bool {
        self.extinction.0 == 0.0 && self.extinction.1 == 0.0
    }
}

/// A curve over [s0, s1]; at its point where they are equal.
pub fn linear<V: CurveValue + std::ops::Sub<Output = V>>(curve: &Curve<V>, s0: f64, s1: f64) -> Linear<V> {
    let start = curve.at(s0);
    let end = if s1 > s0 { curve.just_below(s1) } else { start };
    Linear(start, end - start)
}
