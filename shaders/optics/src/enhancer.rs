//! Enhancers: what changes samples by where they lie and from where they are seen (LFD section 4).
//!
//! An enhancer sees the ray once, and then each sample: its extinction-weighted colour k and extinction τ, its
//! importance, its place x, its scalar s and the gradient g of the scalar. It scales k and τ, and so leaves a picture
//! that does not depend on the step. Enhancers form a chain: each gets what the one before it made. In all laws below,
//! v is the direction in which the ray left the eye (a unit vector of the display frame, also where refraction bends
//! the ray later), x is in metres of the display frame, lerp(a, b, t) = a + (b − a) t, and smoothstep(x, low, high) =
//! t² (3 − 2 t) with t = clamp((x − low) / (high − low), 0, 1).

use super::Trapezoid;
use super::bounds::{OutOfBounds, held};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The most enhancers in a chain.
pub const MOST_ENHANCERS: usize = 3;

/// Limits of a smoothstep: 0 up to `low`, 1 from `high` on; finite, `low` below `high`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ramp {
    /// Where it leaves 0.
    pub low: f64,
    /// Where it reaches 1.
    pub high: f64,
}

impl Ramp {
    /// The smoothstep at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let t = ((x - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

/// Cuts away what lies in front of a plane, but shows it as context to viewers looking along it. With δ = n · (x − point):
///
/// ```text
/// δ > 0:               τ, k ← lerp(1, μ, strength) · (τ, k),   μ = smoothstep(1 − max(0, −n·v), context)
/// −thickness < δ ≤ 0:  u = strength · smoothstep(δ, −thickness, 0)
///                      τ, k ← lerp(1, boost, u) · (τ, k);  the shading weight w ← (1 − u) · w
/// ```
///
/// So the cut surface shows its plain colour, dense.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClipPlane {
    /// A point of the plane, metres, display frame.
    pub point_in_display: DVec3,
    /// Unit normal n, toward what is cut away.
    pub normal_in_display: DVec3,
    /// The limits of 1 − max(0, −n·v), which is 0 for viewers looking straight at the plane.
    pub context: Ramp,
    /// Depth behind the plane over which the sliced tissue is emphasised, metres; 0 for none.
    pub thickness_m: f64,
    /// Factor of the extinction on the plane, at least 0.
    pub boost: f64,
    /// 0 does nothing, 1 does all of it.
    pub strength: f64,
}

/// Opens a sphere to viewers looking along its axis, and keeps edges in it (LFD eq. 4 and 5). With q = (x − centre)
/// · v, ω_d = 1 − (q / radius)², ω_a = smoothstep(max(0, axis · v), facing) and, for g = 0, η = 0, else
///
/// ```text
/// η = ω_a · smoothstep(ι |g| / gradient_most, edges) · (1 − |g·v| / |g|)⁴
/// ```
///
/// (ι = 1 if a scene accumulates no importance: none is given, or γ = 0), inside the sphere, where the light that a
/// sample emits, highlights included, is e:
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
    /// Unit vector along which the tool points: away from the visitor who holds it.
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

/// Gives one band all importance, and shows it alone to viewers looking along the tool. With b = band(s) and
/// w = strength · smoothstep(max(0, axis · v), facing):
///
/// ```text
/// ι ← lerp(ι, b, w)          τ, k ← (1 − w (1 − b)) · (τ, k)
/// ```
///
/// In a scene that accumulates no importance (none is given, or γ = 0) there is none to change.
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

/// One link of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Enhancer {
    /// Clip plane with view-dependent context.
    ClipPlane(ClipPlane),
    /// Context-preserving probe.
    Probe(Probe),
    /// View-dependent band picker.
    BandPicker(BandPicker),
    /// Layer opacity by view direction.
    LayerOpacity(LayerOpacity),
}

type Checked = Result<(), OutOfBounds>;

/// Kernels compute in f32: beyond this, products of numbers that are each fine would not be.
const LARGEST: f64 = 1e6;

impl Enhancer {
    /// Checks what the types do not.
    pub fn check(&self) -> Checked {
        match self {
            Self::ClipPlane(plane) => {
                is_point("a coordinate of the point", plane.point_in_display)?;
                is_unit("the length of the normal", plane.normal_in_display)?;
                is_ramp(&plane.context)?;
                is_at_least_zero("thickness", plane.thickness_m)?;
                is_at_least_zero("boost", plane.boost)?;
                is_share("strength", plane.strength)
            }
            Self::Probe(probe) => {
                is_point("a coordinate of the centre", probe.centre_in_display)?;
                is_above_zero("radius", probe.radius_m)?;
                is_unit("the length of the axis", probe.axis_in_display)?;
                is_ramp(&probe.facing)?;
                is_above_zero("gradient_most", probe.gradient_most)?;
                is_ramp(&probe.edges)?;
                is_share("strength", probe.strength)
            }
            Self::BandPicker(picker) => {
                is_unit("the length of the axis", picker.axis_in_display)?;
                is_ramp(&picker.facing)?;
                is_share("strength", picker.strength)
            }
            Self::LayerOpacity(layer) => {
                is_unit("the length of the axis", layer.axis_in_display)?;
                is_ramp(&layer.facing)?;
                is_at_least_zero("away", layer.away)?;
                is_at_least_zero("toward", layer.toward)
            }
        }
    }

    /// Whether it leaves every picture as it is.
    pub fn is_neutral(&self) -> bool {
        match self {
            Self::ClipPlane(plane) => plane.strength == 0.0,
            Self::Probe(probe) => probe.strength == 0.0,
            Self::BandPicker(picker) => picker.strength == 0.0,
            Self::LayerOpacity(layer) => layer.away == 1.0 && layer.toward == 1.0,
        }
    }

    /// The largest factor that it may multiply an extinction by, at least 1.
    pub fn most_factor(&self) -> f64 {
        match self {
            Self::ClipPlane(plane) => 1.0 + (plane.boost - 1.0).max(0.0) * plane.strength,
            Self::Probe(_) | Self::BandPicker(_) => 1.0,
            Self::LayerOpacity(layer) => layer.away.max(layer.toward).max(1.0),
        }
    }

    /// Whether it may change anything of a volume with these corners in the display frame. A tool held away from the
    /// volume does not; the box around the corners stands for the volume.
    pub fn may_act_within(&self, corners: &[DVec3; 8]) -> bool {
        match self {
            Self::ClipPlane(plane) => corners.iter().any(|&corner| {
                plane.normal_in_display.dot(corner - plane.point_in_display) > -plane.thickness_m
            }),
            Self::Probe(probe) => {
                let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
                let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
                let nearest = probe.centre_in_display.clamp(low, high);
                nearest.distance(probe.centre_in_display) <= probe.radius_m
            }
            Self::BandPicker(_) | Self::LayerOpacity(_) => true,
        }
    }

    /// The largest importance that it may give to scalars in [lo, hi] of which none had more than `told`.
    pub fn most_importance(&self, lo: f64, hi: f64, told: f64) -> f64 {
        match self {
            Self::BandPicker(picker) => {
                told.max(told + (picker.band.max_on(lo, hi) - told) * picker.strength)
            }
            Self::ClipPlane(_) | Self::Probe(_) | Self::LayerOpacity(_) => told,
        }
    }
}

fn is_point(name: &'static str, point: DVec3) -> Checked {
    let is_near = |c: f64| c.abs() <= LARGEST;
    point.to_array().into_iter().try_for_each(|c| held(is_near(c), name, c, "a number of at most a million"))
}

fn is_unit(name: &'static str, vector: DVec3) -> Checked {
    // Rounding of files and of f32 trackers is allowed.
    held((vector.length() - 1.0).abs() < 1e-5, name, vector.length(), "1")
}

fn is_ramp(ramp: &Ramp) -> Checked {
    let is_good =
        ramp.low.abs() <= LARGEST && ramp.high.abs() <= LARGEST && (ramp.low as f32) < ramp.high as f32;
    held(
        is_good,
        "a ramp's lower limit",
        ramp.low,
        "below its upper limit in single precision, and within a million",
    )
}

fn is_at_least_zero(name: &'static str, value: f64) -> Checked {
    held((0.0..=LARGEST).contains(&value), name, value, "a number from 0 to a million")
}

fn is_above_zero(name: &'static str, value: f64) -> Checked {
    held((1.0 / LARGEST..=LARGEST).contains(&value), name, value, "a number from a millionth to a million")
}

fn is_share(name: &'static str, value: f64) -> Checked {
    held((0.0..=1.0).contains(&value), name, value, "a number from 0 to 1")
}
