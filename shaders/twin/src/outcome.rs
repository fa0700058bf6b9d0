//! What one ray brings back.

/// What one ray brings back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast<F> {
    /// Premultiplied linear RGB and opacity.
    pub rgba: [F; 4],
    /// Samples of the volume, gradients not counted.
    pub samples: u32,
    /// Whether a node on the way was too coarse.
    pub is_missing: bool,
}
