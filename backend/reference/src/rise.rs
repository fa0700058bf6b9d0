//! The integration of a span that has no closed form: importance rises on it, or a chain of enhancers acts.

use super::medium::Erasure;
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
/// Two half steps of a method of order 5 are 2⁵ times closer than one step where the emitter is smooth.
pub const GAIN_WHERE_SMOOTH: f64 = 32.0;
/// They are 2² times closer where it has a kink.
pub const GAIN_AT_KINKS: f64 = 4.0;

/// What is integrated over x in [0, 1].
pub trait Emitter {
    /// How much closer two half steps are than one: [`GAIN_WHERE_SMOOTH`] or [`GAIN_AT_KINKS`].
    const GAIN_OF_HALVING: f64;
    /// Optical depth per unit of x, and the light emitted per unit of it.
    fn emission(&self, x: f64) -> (f64, DVec3);
    /// Importance.
    fn importance(&self, x: f64) -> f64;
    /// Rise of importance per unit of x, at least 0.
    fn importance_slope(&self, x: f64) -> f64;
    /// Optical depth from a to b, where it is known in closed form.
    fn depth_between(&self, a: f64, b: f64) -> Option<f64>;
}

/// A span on which importance does not fall: dA = −A p + (1 − A) τ, dC = −C p + (1 − A) e, with p = dP/dx.
pub struct Rise<'a, E> {
    emitter: &'a E,
    /// How importance erases; None if it does not.
    erasure: Option<Erasure>,
    /// Error allowed per unit of what is added or erased. Errors are erased and covered as the light itself is, so the
    /// sum never exceeds a small multiple of it.
    tolerance: f64,
    steps: Cell<u32>,
}

/// Where a step leads, and the optical depth that it saw.
struct Step {
    state: State,
    depth: f64,
}

impl<'a, E: Emitter> Rise<'a, E> {
    /// A rise over the whole of `emitter`.
    pub fn new(emitter: &'a E, erasure: Option<Erasure>, tolerance: f64) -> Self {
        Self { emitter, erasure, tolerance, steps: Cell::new(0) }
    }

    /// Carries `state` over [a, b] of the span, bisecting at most `max_depth` times.
    pub fn advance(&self, state: State, a: f64, b: f64, max_depth: u32) -> State {
        let middle = 0.5 * (a + b);
        let once = self.step(state, a, b).state;
        let first = self.step(state, a, middle);
        let Step { state: twice, depth } = self.step(first.state, middle, b);
        let change = (twice.rgb - once.rgb).abs().max_element().max((twice.opacity - once.opacity).abs());
        let error = change / (E::GAIN_OF_HALVING - 1.0);
        let turnover = self.turnover(a, b, first.depth + depth) * self.open(state);
        let allowed = (self.tolerance * turnover).max(ROUNDING * twice.rgb.max_element().max(1.0));
        self.steps.set(self.steps.get() + 1);
        let is_spent = max_depth == 0 || self.steps.get() > MOST_STEPS;
        // Written so that NaN ends here too.
        let wants_more = error > allowed;
        if !wants_more || is_spent || middle <= a || middle >= b {
            return State { error: state.error + error, ..twice };
        }
        let half = self.advance(state, a, middle, max_depth - 1);
        self.advance(half, middle, b, max_depth - 1)
    }

    /// How much of the light is exchanged on [a, b]: 1 − exp(−depth − P).
    fn turnover(&self, a: f64, b: f64, seen_depth: f64) -> f64 {
        let depth = self.emitter.depth_between(a, b).unwrap_or(seen_depth);
        let kept = self
            .erasure
            .map_or(1.0, |erasure| erasure.kept(self.emitter.importance(a), self.emitter.importance(b)));
        1.0 - kept * (-depth).exp()
    }

    /// The share of errors that will be seen: without erasure, what is covered stays so, and the sum over all steps
    /// of a ray is its opacity.
    fn open(&self, state: State) -> f64 {
        if self.erasure.is_some() { 1.0 } else { 1.0 - state.opacity }
    }

    /// One step of the Radau IIA method; the equations are linear, so its stages are solved for directly.
    fn step(&self, state: State, a: f64, b: f64) -> Step {
        let h = b - a;
        let x = NODES.map(|node| a + h * node);
        let light = x.map(|x| self.emitter.emission(x));
        let extinction = DVec3::from_array(light.map(|light| light.0));
        let erasing = DVec3::from_array(x.map(|x| self.erasing(x)));
        let clear = stages(1.0 - state.opacity, h, extinction + erasing, erasing);
        let erased = if erasing == DVec3::ZERO { DMat3::IDENTITY } else { solver(h, erasing) };
        let mut rgb = DVec3::ZERO;
        for channel in 0..3 {
            let colour = DVec3::from_array(light.map(|light| light.1[channel]));
            let source = colour * extinction * clear;
            rgb[channel] = (erased * (DVec3::splat(state.rgb[channel]) + h * (COLUMNS * source))).z;
        }
        let depth = h * (COLUMNS * extinction).z;
        Step { state: State { rgb, opacity: 1.0 - clear.z, error: state.error }, depth }
    }

    fn erasing(&self, x: f64) -> f64 {
        let rate = |erasure: Erasure| erasure.rate(self.emitter.importance(x));
        self.erasure.map_or(0.0, |erasure| rate(erasure) * self.emitter.importance_slope(x))
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
