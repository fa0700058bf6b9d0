//! How far two pictures are apart.

use super::{OutputError, PictureRef};
use serde::{Deserialize, Serialize};

/// Differences of linear premultiplied colour (red, green, blue; not opacity), where 1 is full brightness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageDifference {
    /// Root of the mean square.
    pub rms: f64,
    /// The largest.
    pub max: f64,
    /// 99.9 % of the differences are not above it.
    pub percentile_999: f64,
    /// Peak signal to noise ratio against a peak of 1, decibels; infinite where the pictures are equal.
    pub psnr_db: f64,
}

impl ImageDifference {
    /// Compares two pictures of one size. A NaN on either side counts as an infinite difference.
    pub fn between(a: PictureRef<'_>, b: PictureRef<'_>) -> Result<Self, OutputError> {
        if (a.width(), a.height()) != (b.width(), b.height()) {
            return Err(OutputError::SizesDiffer(a.width(), a.height(), b.width(), b.height()));
        }
        let mut apart = absolute_differences(a, b);
        let rms = (apart.iter().map(|d| d * d).sum::<f64>() / apart.len() as f64).sqrt();
        let rank = ((apart.len() as f64 * 0.999).ceil() as usize).clamp(1, apart.len()) - 1;
        let max = apart.iter().copied().fold(0.0, f64::max);
        let percentile_999 = *apart.select_nth_unstable_by(rank, f64::total_cmp).1;
        Ok(Self { rms, max, percentile_999, psnr_db: -20.0 * rms.log10() })
    }
}

fn absolute_differences(a: PictureRef<'_>, b: PictureRef<'_>) -> Vec<f64> {
    let difference = |(x, y): (&f32, &f32)| {
        let d = (f64::from(*x) - f64::from(*y)).abs();
        if d.is_nan() { f64::INFINITY } else { d }
    };
    let pixels = a.rgba().chunks_exact(4).zip(b.rgba().chunks_exact(4));
    pixels.flat_map(|(p, q)| p[..3].iter().zip(&q[..3]).map(difference)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_are_not_apart() {
        let rgba = [0.5; 16];
        let picture = PictureRef::new(2, 2, &rgba).unwrap();
        let d = ImageDifference::between(picture, picture).unwrap();
        assert_eq!((d.rms, d.max, d.percentile_999, d.psnr_db), (0.0, 0.0, 0.0, f64::INFINITY));
    }

    #[test]
    fn a_constant_difference_is_every_measure() {
        let (a, b) = ([0.25; 40], [0.35; 40]);
        let view = |rgba| PictureRef::new(10, 1, rgba).unwrap();
        let d = ImageDifference::between(view(&a), view(&b)).unwrap();
        for value in [d.rms, d.max, d.percentile_999] {
            assert!((value - 0.1).abs() < 1e-7);
        }
        assert!((d.psnr_db - 20.0).abs() < 1e-5);
    }

    #[test]
    fn one_pixel_in_a_thousand_shows_in_the_maximum_only() {
        let a = vec![0.0f32; 4 * 10_000];
        let mut b = a.clone();
        b[0] = 1.0;
        let view = |rgba| PictureRef::new(100, 100, rgba).unwrap();
        let d = ImageDifference::between(view(&a), view(&b)).unwrap();
        assert_eq!((d.max, d.percentile_999), (1.0, 0.0));
    }

    #[test]
    fn a_nan_is_not_a_match() {
        let (a, b) = ([f32::NAN; 4], [0.0; 4]);
        let view = |rgba| PictureRef::new(1, 1, rgba).unwrap();
        assert_eq!(ImageDifference::between(view(&a), view(&b)).unwrap().max, f64::INFINITY);
    }
}
