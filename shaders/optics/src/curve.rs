//! A piecewise-linear function of the scalar, given by control points.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What a control point holds: a number or a linear RGB colour.
pub trait CurveValue: Copy + PartialEq {
    /// `self + (other - self) * t`.
    fn lerp(self, other: Self, t: f64) -> Self;
    /// Whether every component is finite and at least zero.
    fn is_finite_and_not_negative(self) -> bool;
}

impl CurveValue for f64 {
    fn lerp(self, other: f64, t: f64) -> f64 {
        self + (other - self) * t
    }
    fn is_finite_and_not_negative(self) -> bool {
        self.is_finite() && self >= 0.0
    }
}

impl CurveValue for DVec3 {
    fn lerp(self, other: DVec3, t: f64) -> DVec3 {
        self + (other - self) * t
    }
    fn is_finite_and_not_negative(self) -> bool {
        self.is_finite() && self.min_element() >= 0.0
    }
}

/// Control points `(s, value)` in rising order of the normalised scalar s in [0, 1]; constant beyond both ends.
/// Two points may share an s: the function jumps there, and takes the later value at the jump itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve<V> {
    points: Vec<(f64, V)>,
}

/// Why control points do not make a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// No control point was given.
    #[error("it has no control points; give at least one")]
    Empty,
    /// A position or value is NaN, infinite or (values only) negative.
    #[error("control point {index} is not a finite number, or is negative; correct that point")]
    NotANumber {
        /// Which control point, from 0.
        index: usize,
    },
    /// Positions fall.
    #[error("control point {index} lies before the previous one; sort the points by scalar")]
    NotSorted {
        /// Which control point, from 0.
        index: usize,
    },
}

impl<V: CurveValue> Curve<V> {
    /// Checks the control points: at least one, finite, not negative, sorted.
    pub fn new(points: Vec<(f64, V)>) -> Result<Self, CurveError> {
        if points.is_empty() {
            return Err(CurveError::Empty);
        }
        for (index, (s, value)) in points.iter().enumerate() {
            if !s.is_finite() || !value.is_finite_and_not_negative() {
                return Err(CurveError::NotANumber { index });
            }
            if index > 0 && points[index - 1].0 > *s {
                return Err(CurveError::NotSorted { index });
            }
        }
        Ok(Self { points })
    }

    /// The same value everywhere; `value` must be finite and not negative.
    pub fn constant(value: V) -> Self {
        assert!(value.is_finite_and_not_negative(), "a constant curve needs a finite value of at least zero");
        Self { points: vec![(0.0, value)] }
    }

    /// The control points, sorted by s.
    pub fn points(&self) -> &[(f64, V)] {
        &self.points
    }

    /// The value at `s`.
    pub fn at(&self, s: f64) -> V {
        let after = self.points.partition_point(|p| p.0 <= s);
        if after == 0 {
            return self.points[0].1;
        }
        let (s0, v0) = self.points[after - 1];
        match self.points.get(after) {
            Some(&(s1, v1)) => v0.lerp(v1, (s - s0) / (s1 - s0)),
            None => v0,
        }
    }

    /// The value just below `s`: it differs from [`Curve::at`] only where the curve jumps.
    pub fn just_below(&self, s: f64) -> V {
        let from = self.points.partition_point(|p| p.0 < s);
        if from == 0 {
            return self.points[0].1;
        }
        let (s0, v0) = self.points[from - 1];
        match self.points.get(from) {
            Some(&(s1, v1)) => v0.lerp(v1, (s - s0) / (s1 - s0)),
            None => v0,
        }
    }

    /// The positions strictly between `lo` and `hi` at which the slope or the value changes.
    pub fn knots_between(&self, lo: f64, hi: f64) -> impl Iterator<Item = f64> + '_ {
        self.points.iter().map(|p| p.0).filter(move |&s| s > lo && s < hi)
    }
}

impl Curve<f64> {
    /// Whether it has one value on the closed interval [lo, hi].
    pub fn is_constant_on(&self, lo: f64, hi: f64) -> bool {
        let value = self.at(lo);
        let ends = [self.just_below(lo), self.at(hi), self.just_below(hi)];
        let inside = self.points.iter().filter(|p| p.0 >= lo && p.0 <= hi).map(|p| p.1);
        ends.into_iter().chain(inside).all(|other| other == value)
    }

    /// The largest value on the closed interval [lo, hi].
    pub fn max_on(&self, lo: f64, hi: f64) -> f64 {
        let ends = self.at(lo).max(self.at(hi)).max(self.just_below(lo)).max(self.just_below(hi));
        self.points.iter().filter(|p| p.0 >= lo && p.0 <= hi).fold(ends, |most, p| most.max(p.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_linear_between_points_and_constant_beyond_them() {
        let curve = Curve::new(vec![(0.2, 1.0), (0.6, 3.0)]).unwrap();
        assert_eq!(curve.at(0.0), 1.0);
        assert!((curve.at(0.4) - 2.0).abs() < 1e-15);
        assert_eq!(curve.at(0.9), 3.0);
    }

    #[test]
    fn jumps_where_two_points_share_a_position() {
        let curve = Curve::new(vec![(0.5, 0.0), (0.5, 4.0)]).unwrap();
        assert_eq!((curve.just_below(0.5), curve.at(0.5)), (0.0, 4.0));
        assert_eq!(curve.max_on(0.0, 0.5), 4.0);
        assert_eq!(curve.max_on(0.0, 0.499), 0.0);
    }

    #[test]
    fn refuses_what_is_not_a_curve() {
        assert_eq!(Curve::<f64>::new(vec![]), Err(CurveError::Empty));
        assert_eq!(Curve::new(vec![(0.0, f64::NAN)]), Err(CurveError::NotANumber { index: 0 }));
        assert_eq!(Curve::new(vec![(0.0, 1.0), (0.5, -1.0)]), Err(CurveError::NotANumber { index: 1 }));
        assert_eq!(Curve::new(vec![(0.5, 1.0), (0.2, 1.0)]), Err(CurveError::NotSorted { index: 1 }));
    }
}
