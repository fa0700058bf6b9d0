//! The number a twin computes with.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// f32 or f64.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The nearest number of this type.
    fn of(value: f64) -> Self;
    /// The same number, or the nearest, of a stored f32.
    fn of_f32(value: f32) -> Self;
    /// A code or a count below 2³¹.
    fn of_u32(value: u32) -> Self;
    /// Rounded to f32.
    fn to_f32(self) -> f32;
    /// Truncated to an index, for numbers from 0 to 2³¹; NaN gives 0.
    fn to_index(self) -> u32;
    /// √x.
    fn sqrt(self) -> Self;
    /// e^x.
    fn exp(self) -> Self;
    /// log₂ x.
    fn log2(self) -> Self;
    /// 2^x.
    fn exp2(self) -> Self;
    /// x^y for x > 0.
    fn powf(self, exponent: Self) -> Self;
    /// The next whole number at or above.
    fn ceil(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;

    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// The smaller.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// 0 up to `low`, 1 from `high` on, smooth between.
    #[inline(always)]
    fn smoothstep(self, low: Self, high: Self) -> Self {
        let t = ((self - low) / (high - low)).most(Self::ZERO).least(Self::ONE);
        t * t * (Self::of(3.0) - Self::of(2.0) * t)
    }
    /// The larger.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
}

macro_rules! real {
    ($type:ty) => {
        impl Real for $type {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn of_f32(value: f32) -> Self {
                value as Self
            }
            #[inline(always)]
            fn of_u32(value: u32) -> Self {
                // Through i32: that is one instruction, and no count or code reaches 2³¹.
                value as i32 as Self
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline(always)]
            fn to_index(self) -> u32 {
                self as i32 as u32
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$type>::sqrt(self)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                <$type>::exp(self)
            }
            #[inline(always)]
            fn log2(self) -> Self {
                <$type>::log2(self)
            }
            #[inline(always)]
            fn exp2(self) -> Self {
                <$type>::exp2(self)
            }
            #[inline(always)]
            fn powf(self, exponent: Self) -> Self {
                <$type>::powf(self, exponent)
            }
            #[inline(always)]
            fn ceil(self) -> Self {
                <$type>::ceil(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$type>::abs(self)
            }
        }
    };
}

real!(f32);
real!(f64);
