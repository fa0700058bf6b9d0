//! A span: a part of a piece within one band of the scalar.

use super::Cubic;
use super::band::Band;
use super::quadrature::{Estimate, integrate};
use super::rise::{Emitter, GAIN_WHERE_SMOOTH};
use super::shading::{Shader, Surface};
use glam::DVec3;

/// Beyond this optical depth nothing of a span's colour is seen: e⁻⁴⁰ is below the rounding of 1.
const OPAQUE_DEPTH: f64 = 40.0;

/// A part of a piece on which all curves are linear in the scalar. Positions on it are x in [0, 1].
pub struct Span<'a> {
    /// The scalar's place in the band.
    places: Cubic,
    /// Optical depth per unit of x.
    density: Cubic,
    band: &'a Band,
    /// The part of the piece, and the shading of the piece.
    part: (f64, f64),
    shader: Option<&'a Shader<'a>>,
}

impl<'a> Span<'a> {
    /// The part (from, to) of a piece with scalar `scalar`, `piece_m` metres long.
    pub fn new(
        scalar: &Cubic,
        part: (f64, f64),
        piece_m: f64,
        band: &'a Band,
        shader: Option<&'a Shader<'a>>,
    ) -> Self {
        let places = band.places(&scalar.part(part.0, part.1));
        let length_m = piece_m * (part.1 - part.0);
        let density = places.scaled(band.extinction.0 * length_m, band.extinction.1 * length_m);
        Self { places, density, band, part, shader }
    }

    /// Optical depth from its start to `x`.
    pub fn depth(&self, x: f64) -> f64 {
        self.density.integral(x).max(0.0)
    }

    /// Optical depth per unit of x.
    pub fn extinction(&self, x: f64) -> f64 {
        self.density.at(x).max(0.0)
    }

    /// The colour shown at `x`, with the shading weight scaled by `weight`.
    pub fn colour(&self, x: f64, weight: f64) -> DVec3 {
        self.shaded(self.band.colour.0 + self.band.colour.1 * self.places.at(x), x, weight)
    }

    /// What light makes at `x` of a colour, with the shading weight scaled by `weight`.
    pub fn shaded(&self, colour: DVec3, x: f64, weight: f64) -> DVec3 {
        let place = self.places.at(x);
        let Some(shader) = self.shader else { return colour };
        let material = self.band.material(place, shader.material());
        shader.shade(&Surface { colour, material, weight }, self.part.0 + x * (self.part.1 - self.part.0))
    }

    /// The band, and the scalar's place in it at `x`.
    pub fn place(&self, x: f64) -> (&'a Band, f64) {
        (self.band, self.places.at(x))
    }

    /// The premultiplied colour of the span alone, ∫ e exp(−∫τ), to `tolerance`.
    pub fn whole_emission(&self, opacity: f64, tolerance: f64, max_depth: u32) -> Estimate {
        if self.shader.is_none() && self.band.colour.1 == DVec3::ZERO {
            return Estimate { value: self.band.colour.0 * opacity, error: 0.0 };
        }
        let f = |x: f64| self.colour(x, 1.0) * (self.extinction(x) * (-self.depth(x)).exp());
        integrate(&f, (0.0, self.visible_end()), tolerance, max_depth)
    }

    /// The x beyond which the span hides itself.
    fn visible_end(&self) -> f64 {
        if self.depth(1.0) <= OPAQUE_DEPTH {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        // The relative width matters: an opaque medium shows a sliver at its front.
        while high - low > 0.01 * high && high > f64::MIN_POSITIVE {
            let middle = 0.5 * (low + high);
            if self.depth(middle) < OPAQUE_DEPTH { low = middle } else { high = middle }
        }
        high
    }
}

impl Emitter for Span<'_> {
    const GAIN_OF_HALVING: f64 = GAIN_WHERE_SMOOTH;

    fn emission(&self, x: f64) -> (f64, DVec3) {
        (self.extinction(x), self.colour(x, 1.0))
    }

    fn importance(&self, x: f64) -> f64 {
        (self.band.importance.0 + self.band.importance.1 * self.places.at(x)).clamp(0.0, 1.0)
    }

    fn importance_slope(&self, x: f64) -> f64 {
        (self.band.importance.1 * self.places.slope(x)).max(0.0)
    }

    fn depth_between(&self, a: f64, b: f64) -> Option<f64> {
        Some(self.depth(b) - self.depth(a))
    }
}
