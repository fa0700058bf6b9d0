//! The gradient of one level, by central differences.

use crate::levels::Level;
use crate::{Casting, Real, sample::differences, vector::Vec3};

/// Shorter gradients (squared) have no direction.
pub const LEAST_SQUARE: f64 = 1e-30;

/// Of the scalar per finest voxel's edge, display frame.
#[inline(always)]
pub(super) fn gradient_in<F: Real>(casting: &Casting<F>, level: &Level<F>, t: F) -> Vec3<F> {
    let in_volume = differences(level.codes, level.point(t)) * level.gradient_scale;
    let m = &casting.scene.volume_from_display;
    Vec3([m[0].dot(in_volume), m[1].dot(in_volume), m[2].dot(in_volume)]) * casting.scene.voxel_m
}
