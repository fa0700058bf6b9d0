//! Clip plane with view-dependent context (LFD section 4).

use super::checks::{Checked, is_at_least_zero, is_point, is_ramp, is_share, is_unit};
use super::{Law, Ramp};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Cuts away what lies before a plane, but shows it as context to who looks along the plane. With δ = n · (x − point):
///
/// ```text
/// δ > 0:               τ, k ← lerp(1, μ, strength) · (τ, k),   μ = smoothstep(1 − max(0, −n·v), context)
/// −thickness < δ ≤ 0:  u = strength · smoothstep(δ, −thickness, 0)
///                      τ, k ← lerp(1, boost, u) · (τ, k);  the shading weight w ← (1 − u) · w
/// ```
///
/// So the tissue that the plane slices shows its plain colour, dense.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClipPlane {
    /// A point of the plane, metres, display frame.
    pub point_in_display: DVec3,
    /// Unit normal n, toward what is cut away.
    pub normal_in_display: DVec3,
    /// The limits of 1 − max(0, −n·v), which is 0 for who looks straight at the plane.
    pub context: Ramp,
    /// Depth behind the plane over which the sliced tissue is emphasised, metres; 0 for none.
    pub thickness_m: f64,
    /// Factor of the extinction on the plane, at least 0.
    pub boost: f64,
    /// 0 does nothing, 1 does all of it.
    pub strength: f64,
}

impl Law for ClipPlane {
    const KEYS: &'static [&'static str] =
        &["point_m", "normal", "context", "thickness_m", "boost", "strength"];

    fn check(&self) -> Checked {
        is_point("point_m", self.point_in_display)?;
        is_unit("normal", self.normal_in_display)?;
        is_ramp("context", &self.context)?;
        is_at_least_zero("thickness_m", self.thickness_m)?;
        is_at_least_zero("boost", self.boost)?;
        is_share("strength", self.strength)
    }

    fn is_neutral(&self) -> bool {
        self.strength == 0.0
    }

    fn most_factor(&self) -> f64 {
        1.0 + (self.boost - 1.0).max(0.0) * self.strength
    }

    fn may_act_within(&self, corners: &[DVec3; 8]) -> bool {
        let above = |corner: DVec3| self.normal_in_display.dot(corner - self.point_in_display);
        corners.iter().any(|&corner| above(corner) > -self.thickness_m)
    }

    fn place(&mut self, point_in_display: DVec3, axis_in_display: Option<DVec3>) {
        self.point_in_display = point_in_display;
        self.normal_in_display = axis_in_display.map_or(self.normal_in_display, |axis| -axis);
    }
}
