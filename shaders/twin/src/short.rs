//! Rays that end before what lies behind something.

/// A ray of a projector that is followed no further than to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortRay {
    /// Its pixel's place in the picture, row by row.
    pub pixel: u32,
    /// How far from the screen it ends, metres; negative on the observer's side.
    pub end_m: f32,
}

impl ShortRay {
    /// As the kernel reads it.
    pub fn words(&self) -> [u32; 2] {
        [self.pixel, self.end_m.to_bits()]
    }
}
