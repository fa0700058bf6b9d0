//! Turning data values into codes over a brick's own range.

use super::{BRICK_VOXELS, Brick, Codes};

/// Integers up to this magnitude, and their neighbours, are exact in f32.
const EXACT_INTEGER: f32 = 16_777_216.0;

/// Bits per stored sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeBits {
    /// 256 codes per brick.
    Eight,
    /// 65536 codes per brick.
    Sixteen,
}

impl CodeBits {
    /// 8 or 16.
    pub fn bits(self) -> u8 {
        match self {
            CodeBits::Eight => 8,
            CodeBits::Sixteen => 16,
        }
    }

    /// The largest code.
    pub fn largest(self) -> u16 {
        match self {
            CodeBits::Eight => 255,
            CodeBits::Sixteen => 65535,
        }
    }

    /// Bytes of a brick's codes.
    pub fn brick_bytes(self) -> usize {
        BRICK_VOXELS * usize::from(self.bits()) / 8
    }
}

/// Quantises [`BRICK_VOXELS`] finite samples. Code 0 is the smallest sample exactly; no code that occurs stands for
/// more than the largest. The error is at most half a step, plus the rounding of the step (at the largest code
/// of 16 bits: 1/128 step; more only where the range is under 1e-33 and steps are subnormal). Whole numbers whose range fits the codes are kept exactly, and so are equal samples (step 0).
pub fn quantise(samples: &[f32], bits: CodeBits) -> Brick {
    assert_eq!(samples.len(), BRICK_VOXELS, "a brick has 32³ samples");
    let (low, high) = range(samples);
    let step = step(samples, low, high, bits);
    let codes = match bits {
        CodeBits::Eight => Codes::U8(codes(samples, low, step, |code| code.min(255.0) as u8)),
        CodeBits::Sixteen => Codes::U16(codes(samples, low, step, |code| code.min(65535.0) as u16)),
    };
    Brick { codes, low, step }
}

/// Smallest and largest sample.
fn range(samples: &[f32]) -> (f32, f32) {
    samples.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

/// Step for a range: 1 where that is exact, else the range over the codes, rounded down so that no code exceeds `high`.
fn step(samples: &[f32], low: f32, high: f32, bits: CodeBits) -> f32 {
    if low == high {
        return 0.0;
    }
    let range = f64::from(high) - f64::from(low);
    let largest = f64::from(bits.largest());
    let exact = |v: &f32| v.abs() <= EXACT_INTEGER && v.trunc() == *v;
    if range <= largest && samples.iter().all(exact) {
        return 1.0;
    }
    let ideal = range / largest;
    let nearest = ideal as f32;
    let down = if f64::from(nearest) > ideal { nearest.next_down() } else { nearest };
    down.max(f32::from_bits(1))
}

fn codes<T>(samples: &[f32], low: f32, step: f32, narrow: impl Fn(f64) -> T) -> Vec<T> {
    let (low, per_step) = (f64::from(low), if step > 0.0 { 1.0 / f64::from(step) } else { 0.0 });
    // Adding a half and cutting off is rounding, for numbers that are not negative.
    samples.iter().map(|&v| narrow((f64::from(v) - low) * per_step + 0.5)).collect()
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
        // Half a step, and the step's own rounding (down, by 2⁻²³ of it or the least f32) times the largest code.
        let rounding = (f64::from(brick.step) / f64::from(1 << 23)).max(f64::from(f32::from_bits(1)));
        let allowed = f64::from(brick.step) * 0.500_001 + f64::from(bits.largest()) * rounding;
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
    fn equal_samples_have_no_step() {
        let brick = quantise(&brick_of(|_| 0.1), CodeBits::Eight);
        assert_eq!((brick.low, brick.step), (0.1, 0.0));
        assert_eq!(brick.value(77), f64::from(0.1f32));
    }
}
