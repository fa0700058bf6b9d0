//! A number that counts what a twin looks up of the volume.

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::atomic::{AtomicU64, Ordering};
use twin::Real;
use twin::real::Number;
use twin_f64::Precision;

/// A twin finds a place among a brick's samples with [`Real::to_index`], reads codes with [`Real::of_u32`], and weighs their sum
/// by this.
const PER_CODE: f64 = 1.0 / 65535.0;
/// Numbers that a twin makes of integers between the two: the place along each axis, and the codes of a scalar.
const OF_SCALAR: u32 = 3 + 8;
/// The same of a gradient, where codes that serve two axes are read for each.
const OF_GRADIENT: u32 = 3 + 48;

static SCALARS: AtomicU64 = AtomicU64::new(0);
static GRADIENTS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    /// Numbers made of integers since the last place.
    static MADE: Cell<u32> = const { Cell::new(0) };
}

/// What was looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LookUps {
    /// Scalars, of 8 codes each, of whatever level.
    pub scalars: u64,
    /// Gradients, of 32 codes each.
    pub gradients: u64,
}

impl LookUps {
    /// What was counted since the last call, by all threads.
    pub fn take() -> Self {
        let take = |count: &AtomicU64| count.swap(0, Ordering::Relaxed);
        Self { scalars: take(&SCALARS), gradients: take(&GRADIENTS) }
    }
}

/// The number: f32.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Counted(f32);

impl Number for Counted {
    fn alike(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn ceil(self) -> Self {
        Self(self.0.ceil())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn least(self, other: Self) -> Self {
        Self(self.0.least(other.0))
    }

    fn most(self, other: Self) -> Self {
        Self(self.0.most(other.0))
    }

    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    fn exp2(self) -> Self {
        Self(self.0.exp2())
    }

    fn powf(self, exponent: Self) -> Self {
        Self(self.0.powf(exponent.0))
    }

    fn choose(self, limit: Self, below: Self, beyond: Self) -> Self {
        Self(self.0.choose(limit.0, below.0, beyond.0))
    }

    fn is_below(self, limit: Self) -> bool {
        self.0.is_below(limit.0)
    }

    fn is_any_below(self, limit: Self) -> bool {
        self.0.is_any_below(limit.0)
    }
}

impl Real for Counted {
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);

    fn of(value: f64) -> Self {
        if value == PER_CODE {
            let count = match MADE.get() {
                OF_SCALAR => &SCALARS,
                OF_GRADIENT => &GRADIENTS,
                other => panic!(
                    "{other} numbers make neither a scalar nor a gradient: the twin looks them up otherwise"
                ),
            };
            count.fetch_add(1, Ordering::Relaxed);
        }
        Self(value as f32)
    }

    fn of_f32(value: f32) -> Self {
        Self(value)
    }

    fn of_u32(value: u32) -> Self {
        MADE.set(MADE.get() + 1);
        Self(f32::of_u32(value))
    }

    fn to_f32(self) -> f32 {
        self.0
    }

    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }

    fn to_index(self) -> u32 {
        MADE.set(0);
        self.0.to_index()
    }

    fn log2(self) -> Self {
        Self(self.0.log2())
    }
}

macro_rules! by_numbers {
    ($($operation:ident $name:ident;)+) => {$(
        impl $operation for Counted {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0))
            }
        }
    )+};
}

by_numbers! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Precision for Counted {}
