//! Ranges of elementary functions over intervals, a little widened for rounding.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Widening for rounding: the functions here are of order one and exact to some 1e-15.
const ROUNDING: f64 = 1e-12;

/// A closed interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// The interval between the values of a monotone function at the ends.
    pub fn monotone(self, function: impl Fn(f64) -> f64) -> Self {
        let (a, b) = (function(self.low), function(self.high));
        Self { low: a.min(b) - ROUNDING, high: a.max(b) + ROUNDING }
    }

    pub fn scaled(self, factor: f64) -> Self {
        let (a, b) = (self.low * factor, self.high * factor);
        Self { low: a.min(b), high: a.max(b) }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    pub fn times(self, other: Self) -> Self {
        let products =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        let low = products.iter().copied().fold(f64::INFINITY, f64::min);
        Self { low, high: products.iter().copied().fold(f64::NEG_INFINITY, f64::max) }
    }

    pub fn cos(self) -> Self {
        let holds = |phase: f64| ((self.low - phase) / TAU).ceil() * TAU + phase <= self.high;
        let ends = self.monotone(f64::cos);
        Self {
            low: if holds(PI) { -1.0 } else { ends.low.max(-1.0) },
            high: if holds(0.0) { 1.0 } else { ends.high.min(1.0) },
        }
    }

    pub fn sin(self) -> Self {
        Self::new(self.low - PI / 2.0, self.high - PI / 2.0).cos()
    }

    /// The part within [0, 1], as bounds of a field.
    pub fn unit(self) -> (f64, f64) {
        (self.low.clamp(0.0, 1.0), self.high.clamp(0.0, 1.0))
    }
}

/// Nearest and farthest distance from the origin to a box.
pub(super) fn distance_to_origin(low: DVec3, high: DVec3) -> Interval {
    let nearest = DVec3::ZERO.clamp(low, high).length();
    let farthest = low.abs().max(high.abs()).length();
    Interval::new(nearest * (1.0 - ROUNDING), farthest * (1.0 + ROUNDING))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosine_over_an_interval_holds_its_extremes() {
        assert_eq!(Interval::new(-0.1, 0.1).cos().high, 1.0);
        assert_eq!(Interval::new(9.0, 10.0).cos().low, -1.0);
        let small = Interval::new(0.5, 0.6).cos();
        assert!(small.low <= 0.6f64.cos() && small.high >= 0.5f64.cos() && small.high < 0.5f64.cos() + 1e-9);
        assert_eq!(Interval::new(0.0, 7.0).sin(), Interval::new(-1.0, 1.0));
    }
}
