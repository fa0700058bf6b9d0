//! The number a twin computes with, or eight of them side by side.

use lanes::*;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// f32 or f64, or eight f32 side by side: what a formula without branches needs.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The nearest number of the same kind.
    fn alike(self, value: f64) -> Self;
    /// √x.
    fn sqrt(self) -> Self;
    /// The next whole number at or above.
    fn ceil(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// The smaller.
    fn least(self, other: Self) -> Self;
    /// The larger.
    fn most(self, other: Self) -> Self;
    /// e^x.
    fn exp(self) -> Self;
    /// 2^x.
    fn exp2(self) -> Self;
    /// x^y for x > 0.
    fn powf(self, exponent: Self) -> Self;
    /// `below` where this is below `limit`, `beyond` elsewhere.
    fn choose(self, limit: Self, below: Self, beyond: Self) -> Self;
    /// Whether this is below `limit`, each of them.
    fn is_below(self, limit: Self) -> bool;
    /// Whether this is below `limit`, any of them.
    fn is_any_below(self, limit: Self) -> bool;

    /// 0 up to `low`, 1 from `high` on, smooth between.
    #[inline(always)]
    fn smoothstep(self, low: Self, high: Self) -> Self {
        let (zero, one) = (self.alike(0.0), self.alike(1.0));
        let t = ((self - low) / (high - low)).most(zero).least(one);
        t * t * (self.alike(3.0) - self.alike(2.0) * t)
    }
}

/// f32 or f64.
pub trait Real: Number + Debug + PartialOrd + Send + Sync + 'static {
    /// The nearest number of this type.
    fn of(value: f64) -> Self;
    /// The same number, or the nearest, of a stored f32.
    fn of_f32(value: f32) -> Self;
    /// A code or a count below 2³¹.
    fn of_u32(value: u32) -> Self;
    /// Rounded to f32.
    fn to_f32(self) -> f32;
    /// The same number.
    fn to_f64(self) -> f64;
    /// Truncated to an index, for numbers from 0 to 2³¹; NaN gives 0.
    fn to_index(self) -> u32;
    /// log₂ x.
    fn log2(self) -> Self;

    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
}

macro_rules! real {
    ($type:ty) => {
        impl Number for $type {
            #[inline(always)]
            fn alike(self, value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$type>::sqrt(self)
            }
            #[inline(always)]
            fn ceil(self) -> Self {
                <$type>::ceil(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$type>::abs(self)
            }
            #[inline(always)]
            fn least(self, other: Self) -> Self {
                if other < self { other } else { self }
            }
            #[inline(always)]
            fn most(self, other: Self) -> Self {
                if other > self { other } else { self }
            }
            #[inline(always)]
            fn exp(self) -> Self {
                <$type>::exp(self)
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
            fn choose(self, limit: Self, below: Self, beyond: Self) -> Self {
                if self < limit { below } else { beyond }
            }
            #[inline(always)]
            fn is_below(self, limit: Self) -> bool {
                self < limit
            }
            #[inline(always)]
            fn is_any_below(self, limit: Self) -> bool {
                self < limit
            }
        }

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
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn to_index(self) -> u32 {
                self as i32 as u32
            }
            #[inline(always)]
            fn log2(self) -> Self {
                <$type>::log2(self)
            }
        }
    };
}

real!(f32);
real!(f64);

impl<S: Simd> Number for f32x8<S> {
    #[inline(always)]
    fn alike(self, value: f64) -> Self {
        splat(self.token(), value as f32)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        SimdFloat::ceil(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        other.simd_lt(self).select(other, self)
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        other.simd_gt(self).select(other, self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let x = self.to_array();
        f32x8::load_array(self.token(), eight!(L => f32::exp(x[L])))
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        let x = self.to_array();
        f32x8::load_array(self.token(), eight!(L => f32::exp2(x[L])))
    }
    /// 0 where x is not above 0: that is asked of most in vain.
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        let (x, y) = (self.to_array(), exponent.to_array());
        f32x8::load_array(self.token(), eight!(L => if x[L] > 0.0 { f32::powf(x[L], y[L]) } else { 0.0 }))
    }
    #[inline(always)]
    fn choose(self, limit: Self, below: Self, beyond: Self) -> Self {
        self.simd_lt(limit).select(below, beyond)
    }
    #[inline(always)]
    fn is_below(self, limit: Self) -> bool {
        self.simd_lt(limit).all_true()
    }
    #[inline(always)]
    fn is_any_below(self, limit: Self) -> bool {
        self.simd_lt(limit).any_true()
    }
}
