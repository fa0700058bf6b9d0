//! The one directional light of a scene, with the material's answer to it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Gradient shading (Phong, two-sided). With g the gradient of the normalised scalar s in the display frame times
/// the finest voxel's edge (so |g| is the change of s per voxel), n = g / |g|, l = toward the light,
/// v = the ray's direction, h = normalize(l − v) and w = |g|² / (|g|² + gradient_half²):
///
/// ```text
/// emission = τ · ( c · (1 − w + w · (ambient + diffuse · |n·l|)) + w · specular · |n·h|^shininess )
/// ```
///
/// So a homogeneous region shows its plain colour, a boundary is shaded, and nothing is undefined where g = 0.
/// Where l = v the highlight is zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Unit vector from the scene toward the light, display frame.
    pub toward_light_in_display: DVec3,
    /// Share of the colour that is seen without light, at least 0.
    pub ambient: f64,
    /// Share of the colour scattered by the light, at least 0.
    pub diffuse: f64,
    /// Strength of the white highlight, at least 0.
    pub specular: f64,
    /// Exponent of the highlight, at least 1.
    pub shininess: f64,
    /// Gradient (change of s per finest voxel) at which shading has half its strength, above 0.
    pub gradient_half: f64,
}

impl Default for Light {
    fn default() -> Self {
        Self {
            toward_light_in_display: DVec3::new(0.3, 0.6, 0.9).normalize(),
            ambient: 0.35,
            diffuse: 0.75,
            specular: 0.2,
            shininess: 24.0,
            gradient_half: 0.02,
        }
    }
}
