//! The picture of one projector.

use serde::{Deserialize, Serialize};

/// Linear RGB premultiplied by opacity, with that opacity; rows from the top, x fastest, 4 numbers per pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectorImage {
    /// Index of the projector in the display.
    pub projector: u32,
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// `4 · width · height` numbers.
    pub rgba: Vec<f32>,
}

/// The same picture as a screen shows it: 8-bit sRGB over black.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScreenImage {
    /// Index of the projector in the display.
    pub projector: u32,
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// `3 · width · height` codes, rows from the top, x fastest.
    pub rgb: Vec<u8>,
}
