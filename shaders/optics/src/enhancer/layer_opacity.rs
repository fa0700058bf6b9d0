//! Layer opacity by view direction (LFD section 4).

use super::checks::{Checked, is_at_least_zero, is_ramp, is_unit};
use super::{Law, Ramp};
use crate::Trapezoid;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Shows a layer, which is a band of scalars, more or less by the direction of view. With b = band(s) and
/// μ = lerp(away, toward, smoothstep(axis · v, facing)): τ, k ← (1 + b (μ − 1)) · (τ, k).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayerOpacity {
    /// The band over the normalised scalar.
    pub band: Trapezoid,
    /// Unit vector that the direction of view is compared with.
    pub axis_in_display: DVec3,
    /// The limits of axis · v, from −1 to 1.
    pub facing: Ramp,
    /// Factor of the layer's extinction where axis · v is low, at least 0.
    pub away: f64,
    /// The same where it is high.
    pub toward: f64,
}

impl Law for LayerOpacity {
    const KEYS: &'static [&'static str] = &["band", "axis", "facing", "away", "toward"];
    const NEEDS_BAND: bool = true;

    fn check(&self) -> Checked {
        is_unit("axis", self.axis_in_display)?;
        is_ramp("facing", &self.facing)?;
        is_at_least_zero("away", self.away)?;
        is_at_least_zero("toward", self.toward)
    }

    fn is_neutral(&self) -> bool {
        self.away == 1.0 && self.toward == 1.0
    }

    fn most_factor(&self, _: &[DVec3; 8]) -> f64 {
        self.away.max(self.toward).max(1.0)
    }

    fn band_mut(&mut self) -> Option<&mut Trapezoid> {
        Some(&mut self.band)
    }

    fn place(&mut self, _: DVec3, axis_in_display: Option<DVec3>) {
        self.axis_in_display = axis_in_display.unwrap_or(self.axis_in_display);
    }
}
