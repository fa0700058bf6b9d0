//! Eight numbers in one instruction: the one crate that knows which library does it.
//!
//! Nothing is contracted or reordered, so every level of instructions gives the same bits.

pub use fearless_simd::prelude::*;
pub use fearless_simd::{Level, Simd, dispatch, f32x4, f32x8, i32x8, mask32x8};

// A closure is compiled without the instructions of the function around it, so none stands where lanes are computed with.

/// The same number eight times.
#[inline(always)]
pub fn splat<S: Simd>(simd: S, value: f32) -> f32x8<S> {
    f32x8::splat(simd, value)
}

/// A list of what an expression is for each of some numbers, written out: a constant holds the number.
#[macro_export]
macro_rules! written_out {
    ($number:ident in [$($value:literal)*] => $what:expr) => {
        [$({
            const $number: usize = $value;
            $what
        }),*]
    };
}

/// Eight of something, one by one.
#[macro_export]
macro_rules! eight {
    ($lane:ident => $value:expr) => {
        $crate::written_out!($lane in [0 1 2 3 4 5 6 7] => $value)
    };
}

/// 0 to 7.
#[inline(always)]
pub fn ramp<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::load_array(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

/// Eight numbers of a list.
#[inline(always)]
pub fn load<S: Simd>(simd: S, list: &[f32], start: usize) -> f32x8<S> {
    f32x8::from_slice(simd, &list[start..start + 8])
}

/// Three or four of something, one by one.
#[macro_export]
macro_rules! each {
    ($c:ident of 3 => $value:expr) => {{
        let [a, b, c] = [0, 1, 2];
        let first = { let $c = a; $value };
        let second = { let $c = b; $value };
        let third = { let $c = c; $value };
        [first, second, third]
    }};
    ($c:ident of 4 => $value:expr) => {{
        let [first, second, third] = $crate::each!($c of 3 => $value);
        let fourth = { let $c = 3; $value };
        [first, second, third, fourth]
    }};
}

/// The low and the high half of eight words, as numbers.
#[inline(always)]
pub fn halves<S: Simd>(simd: S, words: [i32; 8]) -> [f32x8<S>; 2] {
    let words = i32x8::load_array(simd, words);
    let low = i32x8::splat(simd, 0xffff);
    [(words & low).to_float(), ((words >> 16) & low).to_float()]
}

/// The largest of eight numbers that are not negative.
#[inline(always)]
pub fn largest<S: Simd>(numbers: f32x8<S>) -> f32 {
    let zero = splat(numbers.simd, 0.0);
    // A comparison with NaN is false.
    let (low, high) = numbers.simd_gt(zero).select(numbers, zero).split();
    let [a, b, c, d] = low.max(high).to_array();
    let (a, b) = (if a > b { a } else { b }, if c > d { c } else { d });
    if a > b { a } else { b }
}

/// The least of eight numbers.
#[inline(always)]
pub fn least<S: Simd>(numbers: f32x8<S>) -> f32 {
    let infinite = splat(numbers.simd, f32::INFINITY);
    let (low, high) = numbers.simd_lt(infinite).select(numbers, infinite).split();
    let [a, b, c, d] = low.min(high).to_array();
    let (a, b) = (if a < b { a } else { b }, if c < d { c } else { d });
    if a < b { a } else { b }
}

/// The greatest of eight numbers.
#[inline(always)]
pub fn greatest<S: Simd>(simd: S, numbers: f32x8<S>) -> f32 {
    -least(splat(simd, 0.0) - numbers)
}

/// e^−x for x ≥ 0, to a few units of f32.
#[inline(always)]
pub fn exp_of_negative<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    let t = (x * splat(simd, -std::f32::consts::LOG2_E)).max(splat(simd, -126.0));
    let whole = (t + splat(simd, 0.5)).floor();
    let y = (t - whole) * splat(simd, std::f32::consts::LN_2);
    // |y| ≤ 0.35: what the series leaves out is below 1e-8. Pairs of terms do not wait for each other.
    let square = y * y;
    let low = splat(simd, 1.0) + y + (splat(simd, 0.5) + y * splat(simd, 1.0 / 6.0)) * square;
    let high = splat(simd, 1.0 / 24.0)
        + y * splat(simd, 1.0 / 120.0)
        + (splat(simd, 1.0 / 720.0) + y * splat(simd, 1.0 / 5040.0)) * square;
    let sum = low + high * (square * square);
    let exponent: i32x8<S> = whole.to_int();
    let scale: f32x8<S> = ((exponent + i32x8::splat(simd, 127)) << 23).bitcast();
    sum * scale
}

/// (1 − e^−x) / x for x ≥ 0.
#[inline(always)]
pub fn attenuation_mean<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    let one = splat(simd, 1.0);
    // The next term is x⁶/5040. Pairs of terms do not wait for each other.
    let square = x * x;
    let first = one - x * splat(simd, 0.5);
    let second = splat(simd, 1.0 / 6.0) - x * splat(simd, 1.0 / 24.0);
    let third = splat(simd, 1.0 / 120.0) - x * splat(simd, 1.0 / 720.0);
    let series = first + square * (second + square * third);
    let is_small = x.simd_lt(splat(simd, 0.25));
    if is_small.all_true() {
        return series;
    }
    let whole = (one - exp_of_negative(simd, x)) / x;
    is_small.select(series, whole)
}

/// x^y for x in (0, 1] and y ≥ 0; 0 where x is.
#[inline(always)]
pub fn power<S: Simd>(simd: S, x: f32x8<S>, y: f32x8<S>) -> f32x8<S> {
    let least = splat(simd, f32::MIN_POSITIVE);
    let bits: i32x8<S> = x.max(least).bitcast();
    // x = m 2^e with m in [1/√2, √2).
    let offset = i32x8::splat(simd, 0x3f35_04f3);
    let exponent = (bits - offset) >> 23;
    let mantissa: f32x8<S> = (bits - (exponent << 23)).bitcast();
    // ln m = 2 artanh((m − 1) / (m + 1)).
    let one = splat(simd, 1.0);
    let q = (mantissa - one) / (mantissa + one);
    let square = q * q;
    let mut sum = splat(simd, 2.0 / 9.0);
    for factor in [2.0 / 7.0, 2.0 / 5.0, 2.0 / 3.0, 2.0] {
        sum = sum * square + splat(simd, factor);
    }
    let whole: f32x8<S> = exponent.to_float();
    let log = sum * q + whole * splat(simd, std::f32::consts::LN_2);
    let power = exp_of_negative(simd, (splat(simd, 0.0) - log * y).max(splat(simd, 0.0)));
    x.simd_lt(least).select(splat(simd, 0.0), power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attenuation_is_right_from_tiny_to_huge() {
        let level = Level::new();
        for exponent in -60..60 {
            let x = 10f32.powf(exponent as f32 / 10.0);
            let found = dispatch!(level, simd => attenuation_mean(simd, splat(simd, x)).to_array());
            let truth = -(-f64::from(x)).exp_m1() / f64::from(x);
            assert!((f64::from(found[3]) / truth - 1.0).abs() < 1e-6, "{x}: {found:?} for {truth}");
        }
        let none = dispatch!(level, simd => attenuation_mean(simd, splat(simd, 0.0)).to_array());
        assert_eq!(none, [1.0; 8]);
    }
}
