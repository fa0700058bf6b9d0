//! A band of scalars: a trapezoid of four corners.

use crate::Real;

#[inline(always)]
fn clamp<F: Real>(x: F, low: F, high: F) -> F {
    x.most(low).least(high)
}

/// The band at a scalar.
#[inline(always)]
pub(super) fn band_at<F: Real>(corners: &[F; 4], s: F) -> F {
    let [a, b, c, d] = *corners;
    if s < a || s > d {
        F::ZERO
    } else if s < b {
        (s - a) / (b - a)
    } else if s <= c {
        F::ONE
    } else {
        (d - s) / (d - c)
    }
}

/// Its mean between two scalars, flank by flank: nothing cancels.
#[inline(always)]
pub(super) fn band_between<F: Real>(corners: &[F; 4], (s0, s1): (F, F)) -> F {
    let [a, b, c, d] = *corners;
    let (low, high) = (s0.least(s1), s0.most(s1));
    if high <= low {
        return band_at(corners, s0);
    }
    // Mostly a segment lies on one side of every corner: what follows would come to the same, to the bit.
    if low >= b && high <= c {
        return F::ONE;
    }
    if high <= a || low >= d {
        return F::ZERO;
    }
    let half = F::of(0.5);
    let mut sum = clamp(high, b, c) - clamp(low, b, c);
    if b > a {
        let (from, to) = (clamp(low, a, b), clamp(high, a, b));
        sum = sum + (to - from) * (half * (from + to) - a) / (b - a);
    }
    if d > c {
        let (from, to) = (clamp(low, c, d), clamp(high, c, d));
        sum = sum + (to - from) * (d - half * (from + to)) / (d - c);
    }
    (sum / (high - low)).least(F::ONE)
}

/// Its largest value between two scalars.
#[inline(always)]
pub(super) fn band_most<F: Real>(corners: &[F; 4], (s0, s1): (F, F)) -> F {
    let (low, high) = (s0.least(s1), s0.most(s1));
    if high < corners[1] {
        band_at(corners, high)
    } else if low > corners[2] {
        band_at(corners, low)
    } else {
        F::ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use optics::Trapezoid;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(
            mut corners in prop::array::uniform4(-0.2..1.2f64), s0 in 0.0..1.0f64, s1 in 0.0..1.0f64, steep in 0..3,
        ) {
            corners.sort_by(f64::total_cmp);
            if steep == 1 { corners[1] = corners[0]; }
            if steep == 2 { corners[2] = corners[3]; }
            let band = Trapezoid::new(corners).unwrap();
            let count = 4000;
            let points = (0..count).map(|i| s0 + (s1 - s0) * (f64::from(i) + 0.5) / f64::from(count));
            let mean = points.map(|s| band.at(s)).sum::<f64>() / f64::from(count);
            // A steep flank is missed by at most one of the points.
            prop_assert!((band_between(&corners, (s0, s1)) - mean).abs() < 2.0 / f64::from(count));
            let rounded = corners.map(|c| c as f32);
            let in_f32 = band_between(&rounded, (s0 as f32, s1 as f32));
            let same = band_between(&rounded.map(f64::from), (f64::from(s0 as f32), f64::from(s1 as f32)));
            prop_assert!((f64::from(in_f32) - same).abs() < 1e-4);
            prop_assert_eq!(band_at(&corners, s0), band.at(s0));
            prop_assert_eq!(band_most(&corners, (s0, s1)), band.max_on(s0.min(s1), s0.max(s1)));
        }
    }
}
