//! A band of scalars: a trapezoid.

use serde::{Deserialize, Serialize};

/// Four rising corners over the normalised scalar: 0 up to the first, rising to 1 at the second, 1 up to the third,
/// falling to 0 at the fourth. Corners may coincide, which makes a flank steep, and may lie outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trapezoid {
    corners: [f64; 4],
}

/// Why four numbers do not make a trapezoid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a band's corners are {0:?}; give four finite numbers in ascending order")]
pub struct TrapezoidError(pub [f64; 4]);

impl Trapezoid {
    /// Checks the corners: finite, none below the one before it.
    pub fn new(corners: [f64; 4]) -> Result<Self, TrapezoidError> {
        let is_rising = corners.windows(2).all(|pair| pair[0] <= pair[1]);
        let is_good = is_rising && corners.iter().all(|corner| corner.is_finite());
        is_good.then_some(Self { corners }).ok_or(TrapezoidError(corners))
    }

    /// The corners.
    pub fn corners(&self) -> [f64; 4] {
        self.corners
    }

    /// The value at `s`, in [0, 1]; a steep flank belongs to the band.
    pub fn at(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.corners;
        if s < a || s > d {
            0.0
        } else if s < b {
            (s - a) / (b - a)
        } else if s <= c {
            1.0
        } else {
            (d - s) / (d - c)
        }
    }

    /// The largest value on the closed interval [lo, hi].
    pub fn max_on(&self, lo: f64, hi: f64) -> f64 {
        let [_, b, c, _] = self.corners;
        if hi < b {
            self.at(hi)
        } else if lo > c {
            self.at(lo)
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flanks_are_linear_and_steep_ones_belong_to_the_band() {
        let band = Trapezoid::new([0.2, 0.4, 0.5, 0.5]).unwrap();
        let values = [0.1, 0.2, 0.3, 0.4, 0.5, 0.50001].map(|s| band.at(s));
        assert!((values[2] - 0.5).abs() < 1e-12);
        assert_eq!([values[0], values[1], values[3], values[4], values[5]], [0.0, 0.0, 1.0, 1.0, 0.0]);
        assert_eq!(
            (band.max_on(0.0, 0.3), band.max_on(0.45, 0.9), band.max_on(0.6, 0.9)),
            (band.at(0.3), 1.0, 0.0)
        );
    }

    #[test]
    fn refuses_what_is_no_trapezoid() {
        assert!(Trapezoid::new([0.0, 0.2, 0.1, 0.3]).is_err());
        assert!(Trapezoid::new([0.0, f64::NAN, 0.1, 0.3]).is_err());
    }
}
