//! Three numbers.

use super::{Real, real::Number};
use std::ops::{Add, Mul, Sub};

/// A vector of the twin's number type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<F>(pub [F; 3]);

impl Vec3<f64> {
    /// The nearest in the numbers of a twin.
    pub fn rounded<F: Real>(self) -> Vec3<F> {
        Vec3(self.0.map(F::of))
    }
}

impl<F: Real> Vec3<F> {
    /// (0, 0, 0).
    pub const ZERO: Self = Self([F::ZERO; 3]);
}

impl<F: Number> Vec3<F> {
    /// The same number three times.
    #[inline(always)]
    pub fn splat(value: F) -> Self {
        Self([value; 3])
    }

    /// The dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> F {
        let (a, b) = (self.0, other.0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// |v|.
    #[inline(always)]
    pub fn length(self) -> F {
        self.dot(self).sqrt()
    }

    /// `self + (other - self) * t`.
    #[inline(always)]
    pub fn lerp(self, other: Self, t: F) -> Self {
        self + (other - self) * t
    }

    /// f of each component.
    #[inline(always)]
    pub fn map(self, f: impl Fn(F) -> F) -> Self {
        Self(self.0.map(f))
    }
}

impl<F: Number> Add for Vec3<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

impl<F: Number> Sub for Vec3<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    }
}

impl<F: Number> Mul<F> for Vec3<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        let a = self.0;
        Self([a[0] * factor, a[1] * factor, a[2] * factor])
    }
}
