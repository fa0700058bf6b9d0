//! A band of scalars: a trapezoid of four corners.

use crate::real::Number;

#[inline(always)]
fn clamp<N: Number>(x: N, low: N, high: N) -> N {
    x.most(low).least(high)
}

/// The band at a scalar.
#[inline(always)]
pub(super) fn band_at<N: Number>(corners: &[N; 4], s: N) -> N {
    let [a, b, c, d] = *corners;
    let (zero, one) = (s.alike(0.0), s.alike(1.0));
    let (rising, falling) = ((s - a) / (b - a), (d - s) / (d - c));
    let within = s.choose(b, rising, c.choose(s, falling, one));
    s.choose(a, zero, d.choose(s, zero, within))
}

/// Its mean between two scalars, flank by flank: nothing cancels.
#[inline(always)]
pub(super) fn band_between<N: Number>(corners: &[N; 4], (s0, s1): (N, N)) -> N {
    let [a, b, c, d] = *corners;
    let (low, high) = (s0.least(s1), s0.most(s1));
    let (zero, half, one) = (s0.alike(0.0), s0.alike(0.5), s0.alike(1.0));
    // Mostly a segment lies on one side of every corner: what follows would come to the same, to the bit.
    if !low.is_any_below(b) && !c.is_any_below(high) {
        return one;
    }
    if high.is_below(a) || d.is_below(low) {
        return zero;
    }
    let mut sum = clamp(high, b, c) - clamp(low, b, c);
    if a.is_below(b) {
        let (from, to) = (clamp(low, a, b), clamp(high, a, b));
        sum = sum + (to - from) * (half * (from + to) - a) / (b - a);
    }
    if c.is_below(d) {
        let (from, to) = (clamp(low, c, d), clamp(high, c, d));
        sum = sum + (to - from) * (d - half * (from + to)) / (d - c);
    }
    let mean = (sum / (high - low)).least(one);
    if low.is_below(high) { mean } else { low.choose(high, mean, band_at(corners, s0)) }
}

/// Its largest value between two scalars.
#[inline(always)]
pub(super) fn band_most<N: Number>(corners: &[N; 4], (s0, s1): (N, N)) -> N {
    let [_, b, c, _] = *corners;
    let (low, high) = (s0.least(s1), s0.most(s1));
    let falling = c.choose(low, band_at(corners, low), s0.alike(1.0));
    high.choose(b, band_at(corners, high), falling)
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
