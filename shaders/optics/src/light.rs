//! The one directional light of a scene, and the shading law.

use super::Material;
use super::bounds::{OutOfBounds, held};
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
    /// What is made of fine detail.
    pub detail: Detail,
}

impl Light {
    /// Checks what the types do not.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        let strength = match self.detail {
            Detail::None => 0.0,
            Detail::Unsharp { strength } => strength,
            Detail::Exaggerated { contrast } => contrast,
        };
        let factors = [
            ("ambient", self.ambient),
            ("diffuse", self.diffuse),
            ("specular", self.specular),
            ("detail_strength", strength),
        ];
        for (name, value) in factors {
            held((0.0..=1e6).contains(&value), name, value, "a number from 0 to a million")?;
        }
        let exponent = (1.0..=1e6).contains(&self.shininess);
        held(exponent, "shininess", self.shininess, "a number from 1 to a million")?;
        let half = (1e-12..=1e6).contains(&self.gradient_half);
        held(half, "gradient_half", self.gradient_half, "a number from 1e-12 to a million")?;
        let length = self.toward_light_in_display.length();
        held((length - 1.0).abs() < 1e-5, "direction's length", length, "1")
    }

    /// The material of a scene that has no factors per scalar.
    pub fn material(&self) -> Material {
        let Self { ambient, diffuse, specular, shininess, .. } = *self;
        Material { ambient, diffuse, specular, shininess }
    }
}

/// How shading brings out detail, by the gradients of coarser levels: G(f) is the gradient at the fractional level f
/// above the node, linear between those of node (0), parent (1) and grandparent (2), constant beyond, where a node has
/// no such ancestor too; f is the level that the sample itself is filtered at, 0 without quadrilinear filtering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Detail {
    /// Nothing: g = G(f).
    #[default]
    None,
    /// Normal unsharp masking (Cignoni, Scopigno, Tarini 2005): the shading law takes
    /// g = G(f) + strength · (G(f) − G(f + 1)).
    Unsharp {
        /// At least 0; 0 does nothing.
        strength: f64,
    },
    /// Exaggerated shading (Rusinkiewicz, Burns, DeCarlo 2006): in the shading law, |n·l| becomes
    ///
    /// ```text
    /// E = clamp(1/2 + 1/2 (0.5 c₀ + 0.3 c₁ + 0.2 n₂·l), 0, 1)
    /// cᵢ = clamp(contrast · nᵢ·lᵢ₊₁, −1, 1),   lᵢ = p / sqrt(|p|² + 0.01),   p = l − nᵢ (nᵢ·l)
    /// ```
    ///
    /// with nᵢ = −G(f + i) / |G(f + i)|, toward lower values; a term with an nᵢ of no length is 0.
    Exaggerated {
        /// At least 0.
        contrast: f64,
    },
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
            detail: Detail::None,
        }
    }
}
