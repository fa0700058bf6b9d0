//! How far pictures are from the truth.

use serde::Serialize;
use std::fmt;

/// A pixel counts as lit above this opacity.
const LIT: f64 = 0.01;

/// Errors of linear colour and opacity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Root of the mean square, all four numbers of all pixels.
    pub rms: f64,
    /// What 99.9 % of the pixels stay within.
    pub p999: f64,
    /// The largest.
    pub max: f64,
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels that show anything: a black picture must not pass.
    pub lit: usize,
}

impl Errors {
    /// Errors of pairs (found, true) of colour and opacity; None if there is no pair. A NaN is an error of NaN.
    pub fn of(pairs: impl Iterator<Item = ([f64; 4], [f64; 4])>) -> Option<Self> {
        let (mut squares, mut worst, mut lit) = (0.0, Vec::new(), 0);
        for (found, truth) in pairs {
            let difference: [f64; 4] = std::array::from_fn(|c| (found[c] - truth[c]).abs());
            squares += difference.iter().map(|d| d * d).sum::<f64>();
            worst.push(difference.into_iter().fold(0.0, largest_or_nan));
            lit += usize::from(truth[3] > LIT);
        }
        worst.sort_by(f64::total_cmp);
        let pixels = worst.len();
        Some(Self {
            rms: (squares / (4 * pixels) as f64).sqrt(),
            p999: *worst.get((pixels * 999 / 1000).min(pixels.saturating_sub(1)))?,
            max: *worst.last()?,
            pixels,
            lit,
        })
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { rms, p999, max, pixels, lit } = self;
        let [rms, p999, max] = [rms, p999, max].map(|e| e * 255.0);
        write!(f, "RMS {rms:.4}  99.9 % {p999:.3}  max {max:.3} (of 255), {pixels} pixels, {lit} lit")
    }
}

/// The larger of two errors; NaN if either is.
fn largest_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wrong_pixel_is_the_largest_error() {
        let pairs = (0..2000).map(|i| ([if i == 7 { 1.0 } else { 0.0 }; 4], [0.0; 4]));
        let errors = Errors::of(pairs).unwrap();
        assert_eq!((errors.max, errors.p999, errors.pixels, errors.lit), (1.0, 0.0, 2000, 0));
        assert!((errors.rms - (1.0f64 / 2000.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_nan_is_not_overlooked_and_nothing_has_no_errors() {
        let errors = Errors::of([([0.5, f64::NAN, 0.5, 0.5], [0.5; 4])].into_iter()).unwrap();
        assert!(errors.max.is_nan() && errors.rms.is_nan());
        assert_eq!(Errors::of(std::iter::empty()), None);
    }
}
