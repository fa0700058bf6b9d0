//! View-dependent band picker (LFD section 4).

use super::checks::{Checked, is_ramp, is_share, is_unit};
use super::{Law, Ramp};
use crate::Trapezoid;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Gives one band all importance, and shows it alone to who looks along the tool. With b = band(s) and
/// w = strength · smoothstep(max(0, axis · v), facing):
///
/// ```text
/// ι ← lerp(ι, b, w)          τ, k ← (1 − w (1 − b)) · (τ, k)
/// ```
///
/// A scene that gives no importance has none to change; where γ = 0, a probe further on in the chain sees the change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BandPicker {
    /// The band over the normalised scalar.
    pub band: Trapezoid,
    /// Unit vector along which the tool points.
    pub axis_in_display: DVec3,
    /// The limits of axis · v.
    pub facing: Ramp,
    /// 0 does nothing, 1 does all of it.
    pub strength: f64,
}

impl Law for BandPicker {
    const KEYS: &'static [&'static str] = &["band", "axis", "facing", "strength"];
    const NEEDS_BAND: bool = true;

    fn check(&self) -> Checked {
        is_unit("axis", self.axis_in_display)?;
        is_ramp("facing", &self.facing)?;
        is_share("strength", self.strength)
    }

    fn is_neutral(&self) -> bool {
        self.strength == 0.0
    }

    fn most_importance(&self, lo: f64, hi: f64, before: f64) -> f64 {
        before.max(before + (self.band.max_on(lo, hi) - before) * self.strength)
    }

    fn band_mut(&mut self) -> Option<&mut Trapezoid> {
        Some(&mut self.band)
    }

    fn place(&mut self, _: DVec3, axis_in_display: Option<DVec3>) {
        self.axis_in_display = axis_in_display.unwrap_or(self.axis_in_display);
    }
}
