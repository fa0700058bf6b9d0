//! What the links of a chain share: their constants, and what they do with these.

use crate::composite::Sample;
use crate::{Real, vector::Vec3};
use glam::DVec3;
use optics::Trapezoid;

/// A vector of constants that an enhancer does without.
pub(super) const UNUSED: [f64; 4] = [0.0; 4];

/// A vector of constants of a point or direction, and a number.
pub(super) fn with(v: DVec3, w: f64) -> [f64; 4] {
    [v.x, v.y, v.z, w]
}

/// Corners that f32 can tell from each other's flanks: a flank that begins a million domains away is level.
pub(super) fn corners(band: &Trapezoid) -> [f64; 4] {
    band.corners().map(|corner| corner.clamp(-1e6, 1e6))
}

/// k and τ of a sample, scaled.
#[inline(always)]
pub(super) fn scaled<F: Real>(sample: Sample<F>, factor: F) -> Sample<F> {
    Sample { k: sample.k.map(|k| k * factor), ..sample }
}

/// x, y, z of a vector of constants.
#[inline(always)]
pub(super) fn xyz<F: Real>(vector: &[F; 4]) -> Vec3<F> {
    Vec3([vector[0], vector[1], vector[2]])
}
