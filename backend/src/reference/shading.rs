//! The light's answer to a gradient, along one ray.

use super::Cubic;
use glam::{DMat3, DVec3};
use shaders::optics::Light;

/// The shading law of [`Light`] for one direction of view.
#[derive(Clone, Copy, Debug)]
pub struct Shading {
    light: Light,
    half_vector: DVec3,
    /// Gradient of the data value per finest voxel, volume frame → gradient of the scalar per finest voxel's edge,
    /// display frame.
    shading_from_gradient: DMat3,
}

impl Shading {
    /// For rays along `direction_in_display` (unit), a volume placed by `volume_from_display`, a finest voxel of edge
    /// `voxel_m` and a domain `domain_width` data values wide.
    pub fn new(
        light: Light,
        direction_in_display: DVec3,
        volume_from_display: DMat3,
        voxel_m: f64,
        domain_width: f64,
    ) -> Self {
        Self {
            light,
            half_vector: (light.toward_light_in_display - direction_in_display).normalize_or_zero(),
            shading_from_gradient: volume_from_display.transpose() * (voxel_m / domain_width),
        }
    }

    /// The colour that a point of plain colour `colour` shows, given its gradient (data value, volume frame).
    pub fn shade(&self, colour: DVec3, gradient_in_volume: DVec3) -> DVec3 {
        let light = &self.light;
        let gradient = self.shading_from_gradient * gradient_in_volume;
        let square = gradient.length_squared();
        if !(square > 0.0 && square.is_finite()) {
            return colour;
        }
        let normal = gradient / square.sqrt();
        let w = square / (square + light.gradient_half * light.gradient_half);
        let lit = light.ambient + light.diffuse * normal.dot(light.toward_light_in_display).abs();
        let highlight = light.specular * normal.dot(self.half_vector).abs().powf(light.shininess);
        colour * (1.0 - w + w * lit) + w * highlight
    }

    /// An upper bound of any shaded component, for plain components up to `brightest`.
    pub fn brightest(light: &Light, brightest: f64) -> f64 {
        brightest * (light.ambient + light.diffuse).max(1.0) + light.specular
    }
}

/// A gradient along a piece, with the law that shades it.
#[derive(Clone, Copy)]
pub struct Shader<'a> {
    /// The law.
    pub shading: &'a Shading,
    /// Gradient of the data value, volume frame, per finest voxel.
    pub gradient: [Cubic; 3],
}

impl Shader<'_> {
    /// The colour shown at `u` of the piece.
    pub fn shade(&self, colour: DVec3, u: f64) -> DVec3 {
        self.shading.shade(colour, DVec3::from_array(self.gradient.map(|g| g.at(u))))
    }
}
