//! Context-preserving probe (LFD eq. 4 and 5).

use super::checks::{Checked, is_above_zero, is_point, is_ramp, is_share, is_unit};
use super::{Law, Ramp};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Opens a sphere to the look of who looks along its axis, and keeps edges in it (LFD eq. 4 and 5). With q = (x − centre)
/// · v, ω_d = 1 − (q / radius)², ω_a = smoothstep(max(0, axis · v), facing) and, for g = 0, η = 0, else
///
/// ```text
/// η = ω_a · smoothstep(ι |g| / gradient_most, edges) · (1 − |g·v| / |g|)⁴
/// ```
///
/// (ι whatever γ is, as the links before leave it, and 1 where a scene gives none), inside the sphere, where the light that
/// a sample emits, highlights included, is e:
///
/// ```text
/// q < 0:  μ = lerp(0, η, ω_d)          μ_c = 1 − η
/// q ≥ 0:  μ = lerp(η, 1, 1 − ω_d)      μ_c = lerp(1 − η, 1, 1 − ω_d)
/// τ ← lerp(1, μ, strength) · τ         e ← lerp(1, μ, strength) · lerp(1, μ_c, strength) · e
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Centre, metres, display frame.
    pub centre_in_display: DVec3,
    /// Radius, metres, above 0.
    pub radius_m: f64,
    /// Unit vector along which the tool points: away from who holds it.
    pub axis_in_display: DVec3,
    /// The limits of axis · v.
    pub facing: Ramp,
    /// ∇max: the gradient (change of s per finest voxel) that counts as 1, above 0.
    pub gradient_most: f64,
    /// The limits of the rescaled gradient.
    pub edges: Ramp,
    /// 0 does nothing, 1 does all of it.
    pub strength: f64,
}

impl Law for Probe {
    const KEYS: &'static [&'static str] =
        &["centre_m", "radius_m", "axis", "facing", "gradient_most", "edges", "strength"];
    const NEEDS_GRADIENT: bool = true;
    const NEEDS_IMPORTANCE: bool = true;

    fn check(&self) -> Checked {
        is_point("centre_m", self.centre_in_display)?;
        is_above_zero("radius_m", self.radius_m)?;
        is_unit("axis", self.axis_in_display)?;
        is_ramp("facing", &self.facing)?;
        is_above_zero("gradient_most", self.gradient_most)?;
        is_ramp("edges", &self.edges)?;
        is_share("strength", self.strength)
    }

    fn is_neutral(&self) -> bool {
        self.strength == 0.0
    }

    fn may_act_within(&self, corners: &[DVec3; 8]) -> bool {
        let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let nearest = self.centre_in_display.clamp(low, high);
        nearest.distance(self.centre_in_display) <= self.radius_m
    }

    fn place(&mut self, point_in_display: DVec3, axis_in_display: Option<DVec3>) {
        self.centre_in_display = point_in_display;
        self.axis_in_display = axis_in_display.unwrap_or(self.axis_in_display);
    }
}
