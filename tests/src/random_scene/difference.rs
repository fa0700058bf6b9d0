//! How far two pictures of a random scene are apart.

use std::fmt;

/// What two pictures may differ by, in parts of the brightest that a pixel of the scene may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Difference of a pixel's worst number that counts.
    pub pixel: f64,
    /// Share of the pixels that may differ by more.
    pub share: f64,
    /// Mean of the pixels' worst differences.
    pub mean: f64,
}

/// Differences of two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Share of the pixels that differ by more than the limit's `pixel`.
    pub share: f64,
    /// Mean of the pixels' worst differences.
    pub mean: f64,
    /// The worst of all.
    pub max: f64,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { share, mean, max } = self;
        write!(f, "mean {:.4}, max {:.3} (of 255), {:.2} % beyond", 255.0 * mean, 255.0 * max, 100.0 * share)
    }
}

impl Limit {
    /// Whether a difference stays within.
    pub fn holds(&self, difference: &Difference) -> bool {
        difference.share <= self.share && difference.mean <= self.mean
    }
}

/// A NaN differs by more than anything.
pub(super) fn difference(
    pairs: impl Iterator<Item = ([f64; 4], [f64; 4])>,
    scale: f64,
    pixel: f64,
) -> Difference {
    let worst_of = |(a, b): ([f64; 4], [f64; 4])| {
        let differences = (0..4).map(|c| scale * (a[c] - b[c]).abs());
        differences.fold(0.0, |worst: f64, d| if d.is_nan() { f64::INFINITY } else { worst.max(d) })
    };
    let worst: Vec<f64> = pairs.map(worst_of).collect();
    let count = worst.len().max(1) as f64;
    Difference {
        share: worst.iter().filter(|&&d| d > pixel).count() as f64 / count,
        mean: worst.iter().sum::<f64>() / count,
        max: worst.into_iter().fold(0.0, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_holds_within_no_limit() {
        let pairs = [([0.5, f64::NAN, 0.5, 0.5], [0.5; 4]), ([0.5; 4], [0.5; 4])];
        let found = difference(pairs.into_iter(), 1.0, 0.1);
        assert_eq!((found.share, found.max), (0.5, f64::INFINITY));
        assert!(!Limit { pixel: 1.0, share: 1.0, mean: 1e9 }.holds(&found));
    }
}
