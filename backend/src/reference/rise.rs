//! The integration of a span on which importance rises.

use super::medium::Erasure;
use super::span::Span;
use glam::{DMat3, DVec3};
use std::cell::Cell;

/// Colour and opacity accumulated so far, with the error they may carry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Linear RGB, premultiplied.
    pub rgb: DVec3,
    /// Opacity A.
    pub opacity: f64,
    /// Estimated absolute error.
    pub error: f64,
}

/// √6.
const R: f64 = 2.449_489_742_783_178;
/// Nodes of the three-stage Radau IIA method.
const NODES: [f64; 3] = [(4.0 - R) / 10.0, (4.0 + R) / 10.0, 1.0];
/// Its matrix by columns: order 5, and stable for however opaque a medium.
const COLUMNS: DMat3 = DMat3::from_cols(
    DVec3::new((88.0 - 7.0 * R) / 360.0, (296.0 + 169.0 * R) / 1800.0, (16.0 - R) / 36.0),
    DVec3::new((296.0 - 169.0 * R) / 1800.0, (88.0 + 7.0 * R) / 360.0, (16.0 + R) / 36.0),
    DVec3::new((-2.0 + 3.0 * R) / 225.0, (-2.0 - 3.0 * R) / 225.0, 1.0 / 9.0),
);
/// Differences between steps below this share of the light are rounding: bisecting would not lessen them.
const ROUNDING: f64 = 1e-13;
/// Step pairs that one span may cost; a span that wants more is left as it is, and its error says so.
const MOST_STEPS: u32 = 20_000;
/// Two half steps of a method of order 5 are 2⁵ times closer than one step.
const GAIN_OF_HALVING: f64 = 32.0;

/// A span on which importance rises without a fall: dA = −A p + (1 − A) τ, dC = −C p + (1 − A) e, with p = dP/dx.
pub struct Rise<'a> {
    /// The span.
    span: &'a Span<'a>,
    /// How importance erases.
    erasure: Erasure,
    /// Error allowed per unit of what is added or erased. Errors are erased and covered as the light itself is, so the
    /// sum never exceeds a small multiple of it.
    tolerance: f64,
    steps: Cell<u32>,
}

impl<'a> Rise<'a> {
    /// A rise over the whole of `span`.
    pub fn new(span: &'a Span<'a>, erasure: Erasure, tolerance: f64) -> Self {
        Self { span, erasure, tolerance, steps: Cell::new(0) }
    }

    /// Carries `state` over [a, b] of the span, bisecting at most `max_depth` times.
    pub fn advance(&self, state: State, a: f64, b: f64, max_depth: u32) -> State {
        let middle = 0.5 * (a + b);
        let once = self.step(state, a, b);
        let twice = self.step(self.step(state, a, middle), middle, b);
        let change = (twice.rgb - once.rgb).abs().max_element().max((twice.opacity - once.opacity).abs());
        let error = change / (GAIN_OF_HALVING - 1.0);
        let allowed = (self.tolerance * self.turnover(a, b)).max(ROUNDING * twice.rgb.max_element().max(1.0));
        self.steps.set(self.steps.get() + 1);
        let is_spent = max_depth == 0 || self.steps.get() > MOST_STEPS;
        // Written so that what is not a number ends here too.
        let wants_more = error > allowed;
        if !wants_more || is_spent || middle <= a || middle >= b {
            return State { error: state.error + error, ..twice };
        }
        let half = self.advance(state, a, middle, max_depth - 1);
        self.advance(half, middle, b, max_depth - 1)
    }

    /// How much of the light is exchanged on [a, b]: 1 − exp(−depth − P).
    fn turnover(&self, a: f64, b: f64) -> f64 {
        let kept = self.erasure.kept(self.span.importance(a), self.span.importance(b));
        1.0 - kept * (-(self.span.depth(b) - self.span.depth(a))).exp()
    }

    /// One step of the Radau IIA method; the equations are linear, so its stages are solved for directly.
    fn step(&self, state: State, a: f64, b: f64) -> State {
        let h = b - a;
        let x = NODES.map(|node| a + h * node);
        let extinction = DVec3::from_array(x.map(|x| self.span.extinction(x)));
        let erasing = DVec3::from_array(x.map(|x| self.erasing(x)));
        let colours = x.map(|x| self.span.colour(x));
        let clear = stages(1.0 - state.opacity, h, extinction + erasing, erasing);
        let erased = solver(h, erasing);
        let mut rgb = DVec3::ZERO;
        for channel in 0..3 {
            let colour = DVec3::from_array(colours.map(|colour| colour[channel]));
            let source = colour * extinction * clear;
            rgb[channel] = (erased * (DVec3::splat(state.rgb[channel]) + h * (COLUMNS * source))).z;
        }
        State { rgb, opacity: 1.0 - clear.z, error: state.error }
    }

    fn erasing(&self, x: f64) -> f64 {
        self.erasure.rate(self.span.importance(x)) * self.span.importance_slope(x)
    }
}

/// (I + h M diag(rate))⁻¹, with M the method's matrix.
fn solver(h: f64, rate: DVec3) -> DMat3 {
    (DMat3::IDENTITY + COLUMNS * DMat3::from_diagonal(rate * h)).inverse()
}

/// The stages of y' = source − rate · y from `start`.
fn stages(start: f64, h: f64, rate: DVec3, source: DVec3) -> DVec3 {
    solver(h, rate) * (DVec3::splat(start) + h * (COLUMNS * source))
}
