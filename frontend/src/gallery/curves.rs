//! What is derived from curves and bands.

use optics::{Curve, Trapezoid};

/// Half the width of a jump in a derived curve, parts of the domain.
const HAIR: f64 = 1e-9;
/// A value belongs to what is opaque if it is this part as opaque as the most opaque one.
const OPAQUE: f64 = 0.1;

/// The curve times `outside`, or `inside` the band; between both on the band's flanks.
pub(super) fn over_band(curve: &Curve<f64>, band: Trapezoid, outside: f64, inside: f64) -> Curve<f64> {
    let knots = curve.points().iter().map(|point| point.0).chain(band.corners());
    let mut places: Vec<f64> = knots.flat_map(|s| [s - HAIR, s, s + HAIR]).collect();
    places.sort_by(f64::total_cmp);
    let value = |s: f64| curve.at(s) * (outside + (inside - outside) * band.at(s));
    Curve::new(places.into_iter().map(|s| (s, value(s))).collect())
        .expect("the places are sorted, and products of finite numbers of at least zero are such")
}

/// The curve times a finite factor of at least zero.
pub(super) fn scaled(curve: &Curve<f64>, factor: f64) -> Curve<f64> {
    Curve::new(curve.points().iter().map(|&(s, value)| (s, factor * value)).collect())
        .expect("the places are the curve's own, and the values stay finite and at least zero")
}

/// 0 below the band, 1 in it.
pub(super) fn rise_in(band: Trapezoid) -> Curve<f64> {
    over_band(&Curve::constant(1.0), band, 0.0, 1.0)
}

/// The largest value for s in [0, 1].
pub(super) fn most(curve: &Curve<f64>) -> f64 {
    curve.max_on(0.0, 1.0)
}

/// The interval around the most opaque s in [0, 1] on which extinctions are at least a tenth of its own.
pub(super) fn opaque_part(extinction: &Curve<f64>) -> (f64, f64) {
    /// Fine enough for a band's end.
    const STEPS: u32 = 1 << 10;
    let s_of = |step: u32| f64::from(step) / f64::from(STEPS);
    let opacity = |step: &u32| extinction.at(s_of(*step));
    let steps: Vec<u32> = (0..=STEPS).collect();
    let peak = steps.iter().copied().max_by(|a, b| opacity(a).total_cmp(&opacity(b))).unwrap_or(0);
    let is_opaque = |step: &u32| opacity(step) >= OPAQUE * opacity(&peak);
    let low = (0..=peak).rev().take_while(is_opaque).last().unwrap_or(peak);
    let high = (peak..=STEPS).take_while(is_opaque).last().unwrap_or(peak);
    (s_of(low), s_of(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_weighs_a_curve() {
        let curve = Curve::new(vec![(0.2, 2.0), (0.6, 2.0)]).unwrap();
        let weighed = over_band(&curve, Trapezoid::new([0.3, 0.4, 0.5, 0.5]).unwrap(), 1.0, 3.0);
        for (s, expected) in [(0.1, 2.0), (0.35, 4.0), (0.45, 6.0), (0.5, 6.0), (0.501, 2.0)] {
            assert!((weighed.at(s) - expected).abs() < 1e-6, "{s}: {}", weighed.at(s));
        }
    }

    #[test]
    fn the_opaque_part_lies_around_the_peak() {
        let curve = Curve::new(vec![(0.1, 0.0), (0.2, 50.0), (0.3, 0.0), (0.6, 0.0), (0.8, 100.0)]).unwrap();
        let (low, high) = opaque_part(&curve);
        assert!((low - 0.62).abs() < 2e-3 && high == 1.0, "{low} to {high}");
    }
}
