//! The black level: `out = black + (1 − black) · in`, in linear light, so that black is lifted and white stays.
//!
//! It is the last stage of MPCDI (VESA, 2013) before the transfer curve, where `black` is called β: where the pictures of
//! fewer projectors overlap, less of the light that they cannot help shines, and the rest is added.

use super::spread::spread;
use display_config::BlackLevel;

pub(super) enum Black {
    Level([f32; 3]),
    Map(Vec<f32>),
}

impl Black {
    pub fn new(black: &BlackLevel, size: [usize; 2]) -> Self {
        match black {
            BlackLevel::Level(level) => Self::Level(*level),
            BlackLevel::Map(map) => Self::Map(spread(map, size)),
        }
    }

    /// The light of a pixel, by its number, with its black lifted.
    pub fn apply(&self, light: [f32; 3], at: usize) -> [f32; 3] {
        let black = match self {
            Self::Level(level) => *level,
            Self::Map(map) => [map[at]; 3],
        };
        std::array::from_fn(|c| black[c] + (1.0 - black[c]) * light[c])
    }
}
