//! Rays that end before what lies behind something.

use super::ray::far;

/// A ray of a projector that is followed no further than to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortRay {
    /// Its pixel's place in the picture, row by row.
    pub pixel: u32,
    /// How far from the screen it ends, metres; negative on the observer's side.
    pub end_m: f32,
}

impl ShortRay {
    /// All of a pixel's ray.
    pub fn whole(pixel: u32) -> Self {
        Self { pixel, end_m: far() }
    }

    /// As the kernel reads it.
    pub fn words(&self) -> [u32; 2] {
        [self.pixel, self.end_m.to_bits()]
    }
}
