//! Turning data values into codes over a brick's own range.

use super::CodeBits;
use crate::{BRICK_VOXELS, Brick, Codes};

/// Integers up to this magnitude, and their neighbours, are exact in f32.
const EXACT_INTEGER: f32 = 16_777_216.0;
/// Added to a number from 0 to 65535, it leaves the nearest integer in the low bits of an f32.
const ROUNDER: f32 = 8_388_608.0;
/// The same for f64.
const LONG_ROUNDER: f64 = 4_503_599_627_370_496.0;
/// Added to a number up to [`SMALL`] and taken off again, it leaves the nearest integer.
const WHOLE_ROUNDER: f32 = 12_582_912.0;
const SMALL: f32 = 2_097_152.0;
/// Below this step its inverse overflows f32.
const SMALLEST_INVERTIBLE: f32 = 1e-30;
/// Numbers compared side by side.
const LANES: usize = 8;

/// Quantises [`BRICK_VOXELS`] finite samples. Code 0 is the smallest sample exactly; no code that occurs stands for
/// more than the largest. The error is at most half a step, plus the rounding of the step (at the largest code of 16
/// bits: 1/128 step; more only where the range is under 1e-33 and steps are subnormal) and, with 8 bits, of f32
/// (1/10000 step). Whole numbers whose range fits the codes are kept exactly, and so are equal samples (step 0).
pub fn quantise(samples: &[f32], bits: CodeBits) -> Brick {
    assert_eq!(samples.len(), BRICK_VOXELS, "a brick has 32³ samples");
    quantise_within(samples, range(samples), bits)
}

/// [`quantise`] for samples whose smallest and largest are known.
pub(super) fn quantise_within(samples: &[f32], (low, high): (f32, f32), bits: CodeBits) -> Brick {
    let step = step(samples, low, high, bits);
    let is_short = match bits {
        CodeBits::Eight => step >= SMALLEST_INVERTIBLE && (high - low).is_finite(),
        CodeBits::Sixteen => step == 1.0,
    };
    let per_step = if step > 0.0 { 1.0 / f64::from(step) } else { 0.0 };
    let largest = f64::from(bits.largest());
    let long = |v: f32| {
        let code = ((f64::from(v) - f64::from(low)) * per_step).min(largest);
        (code + LONG_ROUNDER).to_bits()
    };
    let per_short_step = per_step as f32;
    let short = |v: f32| nearest((v - low) * per_short_step);
    let codes = match (bits, is_short) {
        (CodeBits::Eight, true) => Codes::U8(samples.iter().map(|&v| short(v) as u8).collect()),
        (CodeBits::Sixteen, true) => Codes::U16(samples.iter().map(|&v| short(v) as u16).collect()),
        (CodeBits::Eight, false) => Codes::U8(samples.iter().map(|&v| long(v) as u8).collect()),
        (CodeBits::Sixteen, false) => Codes::U16(samples.iter().map(|&v| long(v) as u16).collect()),
    };
    Brick::new(codes, low, step)
}

/// The nearest integer to a number from 0 to 65535, in the low bits.
pub(super) fn nearest(number: f32) -> u32 {
    (number + ROUNDER).to_bits()
}

/// Smallest and largest of some finite samples; infinite if there is none.
pub(super) fn range(samples: &[f32]) -> (f32, f32) {
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let (lanes, rest) = samples.as_chunks::<LANES>();
    let (mut low, mut high) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
    // One after the other: of both in one loop the compiler makes five times as many instructions.
    for lane in lanes {
        for i in 0..LANES {
            low[i] = smaller(lane[i], low[i]);
        }
    }
    for lane in lanes {
        for i in 0..LANES {
            high[i] = larger(lane[i], high[i]);
        }
    }
    let lows = low.iter().chain(rest).copied().fold(f32::INFINITY, smaller);
    (lows, high.iter().chain(rest).copied().fold(f32::NEG_INFINITY, larger))
}

/// Step for a range: 1 if that is exact, else the range over the codes, rounded down so that no code exceeds `high`.
fn step(samples: &[f32], low: f32, high: f32, bits: CodeBits) -> f32 {
    if low == high {
        return 0.0;
    }
    let range = f64::from(high) - f64::from(low);
    let largest = f64::from(bits.largest());
    let magnitude = low.abs().max(high.abs());
    if range <= largest && magnitude <= EXACT_INTEGER && are_whole(samples, magnitude) {
        return 1.0;
    }
    let ideal = range / largest;
    let nearest = ideal as f32;
    let down = if f64::from(nearest) > ideal { nearest.next_down() } else { nearest };
    down.max(f32::from_bits(1))
}

/// Whether all samples, none of them beyond a magnitude that fits i32, are whole numbers.
fn are_whole(samples: &[f32], magnitude: f32) -> bool {
    if magnitude > SMALL {
        return samples.iter().all(|&v| (v as i32) as f32 == v);
    }
    // Bits in which a number differs from the integer nearest to it, but for the sign of 0.
    let off = |v: f32| ((v + WHOLE_ROUNDER - WHOLE_ROUNDER).to_bits() ^ v.to_bits()) << 1;
    let (lanes, rest) = samples.as_chunks::<LANES>();
    let mut bits = [0; LANES];
    for lane in lanes {
        for i in 0..LANES {
            bits[i] |= off(lane[i]);
        }
    }
    bits.into_iter().chain(rest.iter().map(|&v| off(v))).all(|bits| bits == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brick_of(value: impl Fn(usize) -> f32) -> Vec<f32> {
        (0..BRICK_VOXELS).map(value).collect()
    }

    fn check_error(samples: &[f32], bits: CodeBits) {
        let brick = quantise(samples, bits);
        let (low, high) = range(samples);
        // Half a step and f32, and the step's own rounding (down, by 2⁻²³ of it or the least f32) times the largest code.
        let rounding = (f64::from(brick.step) / f64::from(1 << 23)).max(f64::from(f32::from_bits(1)));
        let allowed = f64::from(brick.step) * 0.5001 + f64::from(bits.largest()) * rounding;
        for (index, &sample) in samples.iter().enumerate() {
            let value = brick.value(index);
            assert!(
                (value - f64::from(sample)).abs() <= allowed,
                "{value} for {sample}, step {}",
                brick.step
            );
            assert!(f64::from(low) <= value && value <= f64::from(high));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 40, rng_seed: proptest::test_runner::RngSeed::Fixed(3), failure_persistence: None, ..Default::default() })]

        #[test]
        fn the_error_is_at_most_half_a_step(offset in -1e6f32..1e6, scale in 1e-3f32..1e5, twist in 1usize..9999) {
            let samples = brick_of(|i| offset + scale * ((i * twist) % 10007) as f32 / 10007.0);
            check_error(&samples, CodeBits::Eight);
            check_error(&samples, CodeBits::Sixteen);
        }
    }

    #[test]
    fn extreme_ranges_keep_the_law() {
        for (low, high) in [(f32::MIN, f32::MAX), (0.0, f32::MIN_POSITIVE), (1.0, 1.0f32.next_up())] {
            let samples = brick_of(|i| if i % 3 == 0 { low } else { high });
            check_error(&samples, CodeBits::Eight);
            check_error(&samples, CodeBits::Sixteen);
        }
    }

    #[test]
    fn whole_numbers_within_the_codes_are_exact() {
        let samples = brick_of(|i| -32768.0 + (i * 2) as f32);
        let brick = quantise(&samples, CodeBits::Sixteen);
        assert_eq!(brick.step, 1.0);
        assert!(samples.iter().enumerate().all(|(i, &v)| brick.value(i) == f64::from(v)));
        assert_eq!(quantise(&brick_of(|i| (i % 200) as f32), CodeBits::Eight).step, 1.0);
    }

    #[test]
    fn one_sample_that_is_not_whole_is_seen_wherever_it_is() {
        let whole = |offset: f32| brick_of(|i| offset + (i % 200) as f32);
        // -0 is whole, too; the last has no fractions, however large they are.
        for offset in [-0.0, -100.0, 2_000_000.0, 2_097_000.0, 2_097_100.0, 16_777_016.0] {
            assert_eq!(quantise(&whole(offset), CodeBits::Eight).step, 1.0, "{offset}");
        }
        for (offset, off) in [(0.0, 1e-3), (-100.0, 0.5), (2_000_000.0, 0.125), (2_097_100.0, 0.25)] {
            for at in [0, 9, 7777, BRICK_VOXELS - 1] {
                let mut samples = whole(offset);
                samples[at] += off;
                assert_ne!(quantise(&samples, CodeBits::Eight).step, 1.0, "{offset} {at}");
            }
        }
    }

    #[test]
    fn equal_samples_have_no_step() {
        let brick = quantise(&brick_of(|_| 0.1), CodeBits::Eight);
        assert_eq!((brick.low, brick.step), (0.1, 0.0));
        assert_eq!(brick.value(77), f64::from(0.1f32));
    }
}
