//! The colours of debug views: black, blue, magenta, orange, yellow, white.

use crate::{Real, vector::Vec3};
use optics::heat_ramps;

/// The colour at x in [0, 1], linear RGB: five ramps, one after the other.
pub fn heat<F: Real>(x: F) -> Vec3<F> {
    let u = F::of(5.0) * x;
    let mut colour = Vec3::ZERO;
    for (ramp, start) in heat_ramps().into_iter().zip(0..) {
        let part = (u - F::of_u32(start)).most(F::ZERO).least(F::ONE);
        colour = colour + Vec3(ramp.map(F::of)) * part;
    }
    colour
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE L* of a linear colour in sRGB primaries.
    fn lightness(colour: Vec3<f64>) -> f64 {
        let y = Vec3([0.2126, 0.7152, 0.0722]).dot(colour);
        if y > 0.008856 { 116.0 * y.cbrt() - 16.0 } else { 903.3 * y }
    }

    #[test]
    fn lightness_rises_everywhere() {
        let at = |i: u32| lightness(heat(f64::from(i) / 1000.0));
        assert!((1..=1000).all(|i| at(i) > at(i - 1)));
        for (i, expected) in [(0, 0.0), (200, 22.0), (400, 44.0), (600, 66.0), (800, 88.0), (1000, 100.0)] {
            assert!((at(i) - expected).abs() < 0.3, "L* at {i} is {}", at(i));
        }
    }

    #[test]
    fn colours_can_be_shown() {
        for i in 0..=1000 {
            let Vec3(rgb) = heat(f64::from(i) / 1000.0);
            assert!(rgb.iter().all(|c| (0.0..=1.0 + 1e-12).contains(c)), "{rgb:?}");
        }
    }
}
