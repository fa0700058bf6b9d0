//! A ray in the display frame, with its line in the volume frame.

use glam::{DAffine3, DVec3};

/// A half line in the display frame: t ≥ 0 metres from its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, metres.
    pub origin_in_display: DVec3,
    /// Where it goes, a unit vector.
    pub direction_in_display: DVec3,
}

impl Ray {
    /// A ray along `direction_in_display`, which need not have unit length; a zero direction meets nothing.
    pub fn new(origin_in_display: DVec3, direction_in_display: DVec3) -> Self {
        Self { origin_in_display, direction_in_display: direction_in_display.normalize_or_zero() }
    }

    /// The point at `t` metres.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin_in_display + self.direction_in_display * t
    }

    /// The same points in the volume frame, at the same t.
    pub fn line(&self, volume_from_display: &DAffine3) -> Line {
        Line {
            origin: volume_from_display.transform_point3(self.origin_in_display),
            direction: volume_from_display.transform_vector3(self.direction_in_display),
        }
    }
}

/// A ray seen from the volume frame: `origin + t · direction` in finest voxels, t still in metres of the display
/// frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Its point at t = 0, finest voxels.
    pub origin: DVec3,
    /// Finest voxels per metre.
    pub direction: DVec3,
}

impl Line {
    /// The point at `t` metres.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The t at which it crosses `coordinate` on `axis`. Every comparison of positions goes through this one
    /// expression, so neighbouring regions agree to the bit on where one ends.
    pub fn crossing(&self, axis: usize, coordinate: f64) -> f64 {
        (coordinate - self.origin[axis]) / self.direction[axis]
    }

    /// Whether, just after `t`, it is at or beyond `coordinate` on `axis`.
    pub fn is_beyond(&self, t: f64, axis: usize, coordinate: f64) -> bool {
        let speed = self.direction[axis];
        if speed == 0.0 {
            self.origin[axis] >= coordinate
        } else {
            (t >= self.crossing(axis, coordinate)) == (speed > 0.0)
        }
    }

    /// The t at which it leaves the box, infinite for a line that stands still.
    pub fn exit(&self, low: DVec3, high: DVec3) -> f64 {
        let mut exit = f64::INFINITY;
        for axis in 0..3 {
            let speed = self.direction[axis];
            if speed != 0.0 {
                exit = exit.min(self.crossing(axis, if speed > 0.0 { high[axis] } else { low[axis] }));
            }
        }
        exit
    }

    /// The part of `within` that lies in the closed box [0, `high`]; None if it is empty or a single point.
    pub fn clip(&self, high: DVec3, within: (f64, f64)) -> Option<(f64, f64)> {
        let (mut start, mut end) = within;
        for axis in 0..3 {
            if self.direction[axis] == 0.0 {
                if !(0.0..=high[axis]).contains(&self.origin[axis]) {
                    return None;
                }
                continue;
            }
            let (a, b) = (self.crossing(axis, 0.0), self.crossing(axis, high[axis]));
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        (start < end && start.is_finite() && end.is_finite()).then_some((start, end))
    }
}
