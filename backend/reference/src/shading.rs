//! The light's answer to a gradient, along one ray.

use super::field::Levels;
use super::slopes::Slopes;
use glam::DVec3;
use optics::{Detail, Light, Material};

/// Softens the projected light of exaggerated shading where it looks along the normal; its square.
const SHORTEST_PROJECTION_SQUARED: f64 = 0.01;
/// Weights of the levels in exaggerated shading, from the finest.
const LEVEL_WEIGHTS: [f64; 3] = [0.5, 0.3, 0.2];

/// The shading law of [`Light`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Shading {
    light: Light,
    half_vector: DVec3,
}

/// What is shaded.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Plain colour.
    pub colour: DVec3,
    /// Its answer to light.
    pub material: Material,
    /// Factor of the shading weight w.
    pub weight: f64,
}

impl Shading {
    /// For rays along `direction_in_display` (unit).
    pub fn new(light: Light, direction_in_display: DVec3) -> Self {
        Self {
            light,
            half_vector: (light.toward_light_in_display - direction_in_display).normalize_or_zero(),
        }
    }

    /// Levels of which it needs the gradients.
    pub fn levels(light: &Light) -> Levels {
        match light.detail {
            Detail::None => Levels::One,
            Detail::Unsharp { .. } => Levels::Two,
            Detail::Exaggerated { .. } => Levels::Three,
        }
    }

    /// The colour that a surface shows, given the scalar's gradients per finest voxel (display frame) at its own level
    /// and at those above that [`Shading::levels`] asks for.
    pub fn shade(&self, surface: &Surface, gradients: &[DVec3; 3]) -> DVec3 {
        let gradient = match self.light.detail {
            Detail::Unsharp { strength } => gradients[0] + strength * (gradients[0] - gradients[1]),
            Detail::None | Detail::Exaggerated { .. } => gradients[0],
        };
        let square = gradient.length_squared();
        if !(square > 0.0 && square.is_finite()) {
            return surface.colour;
        }
        let normal = gradient / square.sqrt();
        let half = self.light.gradient_half;
        let w = surface.weight * square / (square + half * half);
        let Material { ambient, diffuse, specular, shininess } = surface.material;
        let lit = ambient + diffuse * self.incidence(normal, gradients);
        let highlight = specular * normal.dot(self.half_vector).abs().powf(shininess);
        surface.colour * (1.0 - w + w * lit) + w * highlight
    }

    /// |n·l|, or what stands for it.
    fn incidence(&self, normal: DVec3, gradients: &[DVec3; 3]) -> f64 {
        match self.light.detail {
            Detail::Exaggerated { contrast } => self.exaggerated(contrast, gradients),
            Detail::None | Detail::Unsharp { .. } => normal.dot(self.light.toward_light_in_display).abs(),
        }
    }

    /// E of Rusinkiewicz, Burns, DeCarlo 2006, over three levels.
    fn exaggerated(&self, contrast: f64, gradients: &[DVec3; 3]) -> f64 {
        let light = self.light.toward_light_in_display;
        let normals = gradients.map(|gradient| (-gradient).try_normalize());
        let against_next = |i: usize| {
            let (Some(normal), Some(next)) = (normals[i], normals[i + 1]) else { return 0.0 };
            let projected = light - next * next.dot(light);
            let local = projected / (projected.length_squared() + SHORTEST_PROJECTION_SQUARED).sqrt();
            (contrast * normal.dot(local)).clamp(-1.0, 1.0)
        };
        let coarsest = normals[2].map_or(0.0, |normal| normal.dot(light));
        let terms = [against_next(0), against_next(1), coarsest];
        let sum: f64 = terms.iter().zip(LEVEL_WEIGHTS).map(|(term, weight)| weight * term).sum();
        (0.5 + 0.5 * sum).clamp(0.0, 1.0)
    }

    /// An upper bound of any shaded component, for plain components up to `brightest` and any of `materials`.
    pub fn brightest(materials: impl Iterator<Item = Material>, brightest: f64) -> f64 {
        let shown = |m: Material| brightest * (m.ambient + m.diffuse).max(1.0) + m.specular;
        materials.map(shown).fold(brightest, f64::max)
    }
}

/// A light along a piece.
pub struct Shader<'a> {
    /// The law.
    pub shading: &'a Shading,
    /// Gradients along the piece.
    pub slopes: &'a Slopes,
}

impl Shader<'_> {
    /// How the light answers where a scene has no materials.
    pub fn material(&self) -> Material {
        self.shading.light.material()
    }

    /// The colour shown at `u` of the piece.
    pub fn shade(&self, surface: &Surface, u: f64) -> DVec3 {
        self.shading.shade(surface, &self.slopes.at(Shading::levels(&self.shading.light), u))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIGHT: DVec3 = DVec3::new(0.6, 0.8, 0.0);

    fn shown(detail: Detail, gradients: [DVec3; 3]) -> f64 {
        let light = Light {
            toward_light_in_display: LIGHT,
            ambient: 0.0,
            diffuse: 1.0,
            specular: 0.0,
            gradient_half: 1e-6,
            detail,
            ..Light::default()
        };
        let surface = Surface { colour: DVec3::ONE, material: light.material(), weight: 1.0 };
        Shading::new(light, DVec3::Z).shade(&surface, &gradients).x
    }

    #[test]
    fn unsharp_masking_turns_the_normal_away_from_the_coarser_one() {
        let gradients = [DVec3::X, DVec3::new(1.0, -0.5, 0.0), DVec3::ZERO];
        let exact = DVec3::new(1.0, 1.0, 0.0).normalize().dot(LIGHT);
        assert!((shown(Detail::Unsharp { strength: 2.0 }, gradients) - exact).abs() < 1e-9);
        let none = shown(Detail::None, gradients);
        assert_eq!(shown(Detail::Unsharp { strength: 0.0 }, gradients), none);
    }

    #[test]
    fn exaggerated_shading_is_the_sum_over_levels() {
        // All normals are −x: p = (0, 0.8, 0), so both contrasts are 0, and n₂·l = −0.6.
        let same = shown(Detail::Exaggerated { contrast: 3.0 }, [DVec3::X; 3]);
        assert!((same - (0.5 - 0.5 * 0.2 * 0.6)).abs() < 1e-9, "{same}");
        // n₀ = −y against the same parent: c₀ = −clamp(3 · 0.8 / sqrt(0.64 + 0.01)) = −1.
        let bumpy = shown(Detail::Exaggerated { contrast: 3.0 }, [DVec3::Y, DVec3::X, DVec3::X]);
        assert!((bumpy - (0.5 + 0.5 * (-0.5 - 0.2 * 0.6))).abs() < 1e-9, "{bumpy}");
        let lone = shown(Detail::Exaggerated { contrast: 3.0 }, [DVec3::Y, DVec3::ZERO, DVec3::ZERO]);
        assert!((lone - 0.5).abs() < 1e-9, "{lone}");
    }
}
