//! A span on which a chain of enhancers acts.

use super::Ray;
use super::enhancer::{Chain, Place, Zones};
use super::field::Levels;
use super::rise::{Emitter, GAIN_AT_KINKS};
use super::slopes::Slopes;
use super::span::Span;
use glam::DVec3;

/// A span with the chain that changes its light.
pub struct Enhanced<'a> {
    /// The span as the scene has it; its importance is already the chain's.
    pub span: &'a Span<'a>,
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

impl Emitter for Enhanced<'_> {
    // A ramp over gradients begins and ends within a piece.
    const GAIN_OF_HALVING: f64 = GAIN_AT_KINKS;

    fn emission(&self, x: f64) -> (f64, DVec3) {
        let (band, at) = self.span.place(x);
        let u = self.part.0 + x * (self.part.1 - self.part.0);
        let gradient = self.slopes.map_or(DVec3::ZERO, |slopes| slopes.at(Levels::One, u)[0]);
        let point = self.way.at(self.t.0 + x * (self.t.1 - self.t.0));
        let sample = self.chain.apply(self.zones, &Place { point, gradient, band, at });
        let colour = self.span.colour(x, sample.shading) * sample.colour;
        (self.span.extinction(x) * sample.extinction, colour)
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
