//! What one ray sees.

use glam::DVec3;

/// The light of a ray, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radiance {
    /// Linear RGB, premultiplied by opacity.
    pub rgb: DVec3,
    /// Opacity in [0, 1].
    pub opacity: f64,
    /// Estimated absolute error of each of the four numbers.
    pub error_estimate: f64,
    /// Whether the estimate stayed within the tolerance that was asked for.
    pub reached: bool,
}

impl Radiance {
    /// A ray that meets nothing.
    pub const NOTHING: Self = Self { rgb: DVec3::ZERO, opacity: 0.0, error_estimate: 0.0, reached: true };

    /// This in front of `back`, by ordinary compositing.
    pub fn over(self, back: Self) -> Self {
        let through = 1.0 - self.opacity;
        Self {
            rgb: self.rgb + through * back.rgb,
            opacity: self.opacity + through * back.opacity,
            error_estimate: self.error_estimate + through * back.error_estimate,
            reached: self.reached && back.reached,
        }
    }
}
