//! What a sample shows.

use crate::scene::Scene;
use glam::{DMat3, DVec3, Vec3};
use optics::{Light, Optics};

/// Entries of the table of colour and extinction.
const ENTRIES: usize = 4096;

/// Colour and extinction by scalar, and light.
pub struct Look {
    domain: [f32; 2],
    /// Colour, and extinction per metre.
    table: Vec<[f32; 4]>,
    shading: Option<Shading>,
}

struct Shading {
    light: Light,
    half_vector: Vec3,
    /// From the gradient per finest voxel, data units, to that of the shading law.
    matrix: DMat3,
}

impl Look {
    pub fn of(scene: &Scene) -> Self {
        let optics: &Optics = &scene.frame.optics;
        let voxel_m = scene.frame.voxel_m();
        let (low, high) = optics.domain;
        let per_metre = optics.extinction_per_metre(voxel_m);
        let entry = |i: usize| {
            let s = i as f64 / (ENTRIES - 1) as f64;
            let colour = optics.colour.at(s).as_vec3();
            [colour.x, colour.y, colour.z, (optics.extinction.at(s) * per_metre) as f32]
        };
        let shading = scene.frame.light.map(|light| {
            let toward_viewer =
                DVec3::new(0.0, scene.frame.observer_in_display.y, scene.frame.observer_in_display.z);
            let half_vector = (light.toward_light_in_display + toward_viewer.normalize()).normalize_or_zero();
            let volume_from_display = scene.frame.display_from_volume.matrix3.inverse();
            let matrix = volume_from_display.transpose() * (voxel_m / (high - low));
            Shading { light, half_vector: half_vector.as_vec3(), matrix }
        });
        Self {
            domain: [low as f32, (1.0 / (high - low)) as f32],
            table: (0..ENTRIES).map(entry).collect(),
            shading,
        }
    }

    /// Emission and extinction per metre of a data value, whose gradient is asked for where it matters.
    #[inline]
    pub fn shown(&self, value: f32, gradient: impl FnOnce() -> Vec3) -> [f32; 4] {
        let place = ((value - self.domain[0]) * self.domain[1]).clamp(0.0, 1.0) * (ENTRIES - 1) as f32;
        let below = (place as usize).min(ENTRIES - 2);
        let [a, b] = [self.table[below], self.table[below + 1]];
        let part = place - below as f32;
        let [r, g, b, extinction]: [f32; 4] = std::array::from_fn(|i| a[i] + part * (b[i] - a[i]));
        if extinction == 0.0 {
            return [0.0; 4];
        }
        let colour = Vec3::new(r, g, b);
        let lit = self.shading.as_ref().map_or(colour, |shading| shading.lit(colour, gradient()));
        [lit.x * extinction, lit.y * extinction, lit.z * extinction, extinction]
    }
}

impl Shading {
    fn lit(&self, colour: Vec3, gradient: Vec3) -> Vec3 {
        let gradient = self.matrix.as_mat3() * gradient;
        let square = gradient.length_squared();
        if square <= 0.0 {
            return colour;
        }
        let Light { toward_light_in_display, ambient, diffuse, specular, shininess, gradient_half, .. } =
            self.light;
        let normal = gradient / square.sqrt();
        let weight = square / (square + (gradient_half * gradient_half) as f32);
        let light = ambient as f32 + diffuse as f32 * normal.dot(toward_light_in_display.as_vec3()).abs();
        let highlight = specular as f32 * normal.dot(self.half_vector).abs().powf(shininess as f32);
        colour * (1.0 - weight + weight * light) + weight * highlight
    }
}
