//! The blend: a factor of linear light for each pixel.

use super::spread::spread;
use display_config::LightMap;

pub(super) struct Blend {
    pub(super) factors: Vec<f32>,
}

impl Blend {
    pub fn new(map: &LightMap, size: [usize; 2]) -> Self {
        Self { factors: spread(map, size) }
    }

    /// What remains of the light of a pixel, by its number.
    pub fn apply(&self, light: [f32; 3], at: usize) -> [f32; 3] {
        light.map(|channel| channel * self.factors[at])
    }
}
