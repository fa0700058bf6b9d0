//! What the numbers of enhancers must be.

use super::Ramp;
use crate::bounds::{OutOfBounds, held};
use glam::DVec3;

pub(super) type Checked = Result<(), OutOfBounds>;

/// Kernels compute in f32: beyond this, products of numbers that are each fine would not be.
const LARGEST: f64 = 1e6;

pub(super) fn is_point(name: &'static str, point: DVec3) -> Checked {
    let is_near = |c: f64| c.abs() <= LARGEST;
    point.to_array().into_iter().try_for_each(|c| held(is_near(c), name, c, "a number of at most a million"))
}

pub(super) fn is_unit(name: &'static str, vector: DVec3) -> Checked {
    // Rounding of files and of f32 trackers is allowed.
    held((vector.length() - 1.0).abs() < 1e-5, name, vector.length(), "1")
}

pub(super) fn is_ramp(name: &'static str, ramp: &Ramp) -> Checked {
    let is_good =
        ramp.low.abs() <= LARGEST && ramp.high.abs() <= LARGEST && (ramp.low as f32) < ramp.high as f32;
    held(
        is_good,
        name,
        if ramp.low.abs() <= LARGEST { ramp.high } else { ramp.low },
        "two limits of at most a million, the first below the second in single precision",
    )
}

pub(super) fn is_at_least_zero(name: &'static str, value: f64) -> Checked {
    held((0.0..=LARGEST).contains(&value), name, value, "a number from 0 to a million")
}

pub(super) fn is_at_least_one(name: &'static str, value: f64) -> Checked {
    held((1.0..=LARGEST).contains(&value), name, value, "a number from 1 to a million")
}

pub(super) fn is_above_zero(name: &'static str, value: f64) -> Checked {
    held((1.0 / LARGEST..=LARGEST).contains(&value), name, value, "a number from a millionth to a million")
}

pub(super) fn is_share(name: &'static str, value: f64) -> Checked {
    held((0.0..=1.0).contains(&value), name, value, "a number from 0 to 1")
}
