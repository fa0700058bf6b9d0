//! The sRGB curve, exactly.

use std::sync::LazyLock;

/// Entries of the table that guesses a code; finer than the steepest part of the curve, so a guess is off by at most one.
const GUESSES: usize = 4096;

/// The curve as tables.
struct Curve {
    /// The smallest linear values whose codes are above 0, 1, …; nothing is above 255.
    edges: [f32; 256],
    /// The code at the low end of each of `GUESSES` equal parts of [0, 1].
    guess: Vec<u8>,
}

static CURVE: LazyLock<Curve> = LazyLock::new(|| {
    let edge = |i: usize| if i < 255 { smallest_above((i as f64 + 0.5) / 255.0) } else { f32::INFINITY };
    let edges: [f32; 256] = std::array::from_fn(edge);
    let code = |x: f32| edges.partition_point(|edge| *edge <= x) as u8;
    let guess = (0..=GUESSES).map(|i| code(i as f32 / GUESSES as f32)).collect();
    Curve { edges, guess }
});

impl Curve {
    fn code(&self, linear: f32) -> u8 {
        // Not `clamp`: it hands NaN on, while this comparison sends it to black.
        let x = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
        let guess = self.guess[(x * GUESSES as f32) as usize];
        guess + u8::from(self.edges[usize::from(guess)] <= x)
    }
}

/// The 8-bit sRGB code of a linear value: `round(255 · curve(x))`, clamped; NaN is 0.
pub fn srgb_code(linear: f32) -> u8 {
    CURVE.code(linear)
}

/// The codes of a pixel's red, green and blue.
pub(crate) fn srgb_codes(pixel: &[f32]) -> [u8; 3] {
    [pixel[0], pixel[1], pixel[2]].map(srgb_code)
}

/// The smallest linear values of codes 1 to 255.
#[cfg(feature = "gpu")]
pub(crate) fn srgb_edges() -> &'static [f32] {
    &CURVE.edges[..255]
}

/// The encoding curve of IEC 61966-2-1, from linear to sRGB, on [0, 1].
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The light of an encoded value on [0, 1]: the inverse of the encoding curve.
pub(crate) fn srgb_light(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The smallest f32 that encodes to at least `encoded`.
fn smallest_above(encoded: f64) -> f32 {
    let mut x = srgb_light(encoded) as f32;
    while encode(f64::from(x)) >= encoded {
        x = x.next_down();
    }
    while encode(f64::from(x)) < encoded {
        x = x.next_up();
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_rounded_curve_everywhere() {
        for i in 0..=200_000u32 {
            let x = i as f32 / 200_000.0;
            let expected = (255.0 * encode(f64::from(x))).round() as u8;
            assert_eq!(srgb_code(x), expected, "at {x}");
        }
    }

    #[test]
    fn every_code_comes_back_from_its_own_value() {
        for code in 0..=255u8 {
            assert_eq!(srgb_code(srgb_light(f64::from(code) / 255.0) as f32), code);
        }
    }

    #[test]
    fn what_is_outside_clamps() {
        assert_eq!([2.0, f32::INFINITY, -1.0, f32::NAN].map(srgb_code), [255, 255, 0, 0]);
    }
}
