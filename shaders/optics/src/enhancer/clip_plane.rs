//! Clip plane with view-dependent context (LFD section 4).

use super::checks::{Checked, is_at_least_one, is_at_least_zero, is_point, is_ramp, is_share, is_unit};
use super::{Law, Ramp};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Cuts away what lies before a plane, but shows it as context to who looks along the plane. With δ = n · (x − point):
///
/// ```text
/// δ > 0:               τ, k ← lerp(1, μ, strength) · (τ, k),   μ = smoothstep(1 − max(0, −n·v), context)
/// −thickness < δ ≤ 0:  y = 1 − strength · (1 + δ / thickness)
///                      τ, k ← min(1/y² − 2 + 2y, boost) · (τ, k);  the shading weight w ← (1 − u) · w
///                      u = strength · smoothstep(δ, −thickness, 0)
/// ```
///
/// At full strength the optical depth of what is left of a slice grows beyond all bounds as the plane comes near, so
/// whatever tissue the plane slices is opaque there and shows its plain colour.
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
    /// The most that extinction is multiplied by, at least 1: [`Self::OPAQUE`], or less for a slice that stays transparent.
    pub boost: f64,
    /// 0 does nothing, 1 does all of it.
    pub strength: f64,
}

impl ClipPlane {
    /// The boost for full opacity: so much that tissue of an optical depth of a hundredth over the thickness is opaque, and
    /// so little that single precision can tell the places where it is reached.
    pub const OPAQUE: f64 = 1e6;

    /// Factor of the extinction of what the plane slices, at y = `edge`.
    pub fn emphasis(edge: f64) -> f64 {
        1.0 / (edge * edge) - 2.0 + 2.0 * edge
    }
}

impl Law for ClipPlane {
    const KEYS: &'static [&'static str] =
        &["point_m", "normal", "context", "thickness_m", "boost", "strength"];

    fn check(&self) -> Checked {
        is_point("point_m", self.point_in_display)?;
        is_unit("normal", self.normal_in_display)?;
        is_ramp("context", &self.context)?;
        is_at_least_zero("thickness_m", self.thickness_m)?;
        is_at_least_one("boost", self.boost)?;
        is_share("strength", self.strength)
    }

    fn is_neutral(&self) -> bool {
        self.strength == 0.0
    }

    fn most_factor(&self, corners: &[DVec3; 8]) -> f64 {
        let above = corners.map(|corner| self.normal_in_display.dot(corner - self.point_in_display));
        let nearest = above.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0);
        let is_before = above.iter().all(|&above| above > 0.0);
        if is_before || nearest <= -self.thickness_m {
            return 1.0;
        }
        Self::emphasis(1.0 - self.strength * (1.0 + nearest / self.thickness_m)).min(self.boost)
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
