//! A span on which a chain of enhancers acts, or whose values stand for a spread of scalars.

use super::enhancer::{Chain, Place, Zones};
use super::field::Levels;
use super::medium::Medium;
use super::rise::{Emitter, GAIN_AT_KINKS};
use super::slopes::Slopes;
use super::span::Span;
use super::{Cubic, Ray};
use glam::DVec3;

/// The scalars that values along a piece stand for: of equal share from so far below each to so far above.
pub struct Spread<'a> {
    /// The optics.
    pub medium: &'a Medium,
    /// The scalar along the piece, not clamped.
    pub scalar: Cubic,
    /// How far its scalars reach.
    pub half: Cubic,
    /// Length of the span, metres.
    pub length_m: f64,
}

/// A span with the chain that changes its light.
pub struct Enhanced<'a> {
    /// The span as the scene has it; its importance is already the chain's.
    pub span: &'a Span<'a>,
    /// What the span's values stand for, where it is more than themselves.
    pub spread: Option<Spread<'a>>,
    /// The chain.
    pub chain: &'a Chain,
    /// Which parts of its laws hold on the span.
    pub zones: &'a Zones,
    /// Where the span lies: a straight path, and the t of its ends.
    pub way: &'a Ray,
    /// See `way`.
    pub t: (f64, f64),
    /// The span's part of its piece.
    pub part: (f64, f64),
    /// Gradients along the piece, where they are wanted.
    pub slopes: Option<&'a Slopes>,
}

impl Spread<'_> {
    /// Mean extinction and mean of extinction times colour at a place u of the piece.
    fn light(&self, u: f64) -> (f64, DVec3) {
        let (scalar, half) = (self.scalar.at(u), self.half.at(u).max(0.0));
        self.medium.mean_light(scalar - half, scalar + half)
    }
}

impl Emitter for Enhanced<'_> {
    // A ramp over gradients begins and ends within a piece.
    const GAIN_OF_HALVING: f64 = GAIN_AT_KINKS;

    fn emission(&self, x: f64) -> (f64, DVec3) {
        let (band, at) = self.span.place(x);
        let u = self.part.0 + x * (self.part.1 - self.part.0);
        let gradient = self.slopes.map_or(DVec3::ZERO, |slopes| slopes.at(Levels::One, u)[0]);
        let point = self.way.at(self.t.0 + x * (self.t.1 - self.t.0));
        let sample = self.chain.apply(self.zones, &Place { point, gradient, band, at });
        let Some(spread) = &self.spread else {
            let colour = self.span.colour(x, sample.shading) * sample.colour;
            return (self.span.extinction(x) * sample.extinction, colour);
        };
        let (extinction, light) = spread.light(u);
        let colour = if extinction > 0.0 { light / extinction } else { DVec3::ZERO };
        let colour = self.span.shaded(colour, x, sample.shading) * sample.colour;
        (extinction * spread.length_m * sample.extinction, colour)
    }

    fn importance(&self, x: f64) -> f64 {
        self.span.importance(x)
    }

    fn importance_slope(&self, x: f64) -> f64 {
        self.span.importance_slope(x)
    }

    fn depth_between(&self, _a: f64, _b: f64) -> Option<f64> {
        None
    }
}
