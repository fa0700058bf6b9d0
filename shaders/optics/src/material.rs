//! How a material reflects light.

use super::CurveValue;
use serde::{Deserialize, Serialize};

/// The factors of the shading law: see [`super::Light`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Share of the colour that is seen without light, at least 0.
    pub ambient: f64,
    /// Share of the colour scattered by the light, at least 0.
    pub diffuse: f64,
    /// Strength of the white highlight, at least 0.
    pub specular: f64,
    /// Exponent of the highlight, at least 1.
    pub shininess: f64,
}

impl Material {
    /// Ambient, diffuse, specular, shininess.
    pub fn to_array(self) -> [f64; 4] {
        [self.ambient, self.diffuse, self.specular, self.shininess]
    }
}

impl CurveValue for Material {
    fn lerp(self, other: Self, t: f64) -> Self {
        Self {
            ambient: self.ambient.lerp(other.ambient, t),
            diffuse: self.diffuse.lerp(other.diffuse, t),
            specular: self.specular.lerp(other.specular, t),
            shininess: self.shininess.lerp(other.shininess, t),
        }
    }
    fn is_finite_and_not_negative(self) -> bool {
        self.to_array().into_iter().all(|factor| factor.is_finite() && factor >= 0.0)
    }
}
