//! What the links of a chain share: their constants, and what they do with these.

use crate::composite::Sample;
use crate::four::each;
use crate::real::Number;
use crate::scene::Constants;
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

/// A scene's constants for a number of rays: as many as `number` is of.
#[inline(always)]
pub(super) fn alike<F: Real, N: Number>(number: N, constants: &Constants<F>) -> Constants<N> {
    each!(V => each!(C => number.alike(constants[V][C].to_f64())))
}

/// k and τ of a sample, scaled.
#[inline(always)]
pub(super) fn scaled<N: Number>(sample: Sample<N>, factor: N) -> Sample<N> {
    Sample { k: each!(C => sample.k[C] * factor), ..sample }
}

/// x, y, z of a vector of constants.
#[inline(always)]
pub(super) fn xyz<N: Copy>(vector: &[N; 4]) -> Vec3<N> {
    Vec3([vector[0], vector[1], vector[2]])
}
