//! The accumulation of light along one ray.

use super::medium::{Band, Erasure, Medium};
use super::rise::{Rise, State};
use super::shading::{Shader, Shading};
use super::span::Span;
use super::{Cubic, Piece, Radiance, Visitor};
use glam::DVec3;
use std::ops::ControlFlow;

/// A ray ends when what may still change is below this share of the tolerance.
const EXIT_SHARE: f64 = 0.1;

/// How closely the model is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrator {
    /// Absolute error allowed in colour and opacity, above 0.
    pub tolerance: f64,
    /// How often a span may be bisected.
    pub max_depth: u32,
}

impl Default for Integrator {
    fn default() -> Self {
        Self { tolerance: 1e-5, max_depth: 48 }
    }
}

/// A ray on its way: takes pieces, composites their spans exactly one after the other.
///
/// Each span's colour is wanted to `tolerance` per unit of its own opacity. Errors are hidden and erased as the light
/// is, so they add up to no more than `tolerance` times the ray's opacity.
pub struct Accumulator<'a> {
    integrator: Integrator,
    medium: &'a Medium,
    shading: Option<&'a Shading>,
    erasure: Option<Erasure>,
    brightest: f64,
    state: State,
    importance: f64,
}

impl<'a> Accumulator<'a> {
    /// At the start of a ray. `brightest` bounds every shaded colour component.
    pub fn new(
        integrator: Integrator,
        medium: &'a Medium,
        shading: Option<&'a Shading>,
        brightest: f64,
    ) -> Self {
        let state = State { rgb: DVec3::ZERO, opacity: 0.0, error: 0.0 };
        Self { integrator, medium, shading, erasure: medium.erasure, brightest, state, importance: 0.0 }
    }

    /// The same, without importance.
    pub fn without_importance(self) -> Self {
        Self { erasure: None, ..self }
    }

    /// What was seen so far.
    pub fn radiance(&self) -> Radiance {
        let State { rgb, opacity, error } = self.state;
        let reached = error <= self.integrator.tolerance;
        Radiance { rgb, opacity: opacity.clamp(0.0, 1.0), error_estimate: error, reached }
    }

    /// A bound of what the rest of the ray may change.
    fn may_still_change(&self) -> f64 {
        let kept = self
            .erasure
            .filter(|e| e.largest > self.importance)
            .map_or(1.0, |e| e.kept(self.importance, e.largest));
        let open = 1.0 - kept * self.state.opacity;
        // What is erased of the past, and what is seen of the future.
        (open + (1.0 - kept)) * self.brightest.max(1.0)
    }

    /// Lets importance jump or rise to `importance` at a place without extinction.
    fn raise(&mut self, importance: f64) {
        if let Some(erasure) = self.erasure.filter(|_| importance > self.importance) {
            let kept = erasure.kept(self.importance, importance);
            self.state.rgb *= kept;
            self.state.opacity *= kept;
            self.state.error *= kept;
            self.importance = importance;
        }
    }

    /// Ordinary compositing of a span.
    fn pass(&mut self, span: &Span) {
        let depth = span.depth(1.0);
        if depth <= 0.0 {
            return;
        }
        let opacity = -(-depth).exp_m1();
        let tolerance = 0.5 * self.integrator.tolerance * opacity;
        let emission = span.emission(opacity, tolerance, self.integrator.max_depth);
        let through = 1.0 - self.state.opacity;
        self.state.rgb += through * emission.value;
        self.state.opacity += through * opacity;
        self.state.error += through * emission.error;
    }

    /// A span on which importance rises from ι_max to `importance`.
    fn rise(&mut self, span: &Span, importance: f64, erasure: Erasure) {
        if span.depth(1.0) <= 0.0 || erasure.kept(self.importance, importance) <= 0.0 {
            // Nothing is added, or all that is added is erased before the end.
            self.raise(importance);
            return;
        }
        let rise = Rise::new(span, erasure, 0.25 * self.integrator.tolerance);
        let kept = erasure.kept(self.importance, importance);
        let before = State { error: 0.0, ..self.state };
        let after = rise.advance(before, 0.0, 1.0, self.integrator.max_depth);
        self.state = State { error: after.error + kept * self.state.error, ..after };
        self.importance = importance;
    }
}

/// A piece on its way through the accumulator.
struct Passage<'p> {
    scalar: Cubic,
    length_m: f64,
    shader: Option<Shader<'p>>,
}

impl<'p> Passage<'p> {
    fn span(&self, part: (f64, f64), band: &'p Band) -> Span<'p> {
        Span::new(&self.scalar, part, self.length_m, band, self.shader)
    }
}

impl<'a> Accumulator<'a> {
    /// A stretch on which the scalar is monotone: it is cut at every knot.
    fn monotone(&mut self, passage: &Passage<'a>, from: f64, to: f64) {
        let medium = self.medium;
        let end = passage.scalar.at(to);
        let (mut u, mut s) = (from, passage.scalar.at(from));
        for knot in medium.knots_between(s, end) {
            let next = passage.scalar.crossing(u, to, knot).clamp(u, to);
            self.leg(passage, (u, next), (s, knot));
            (u, s) = (next, knot);
        }
        self.leg(passage, (u, to), (s, end));
    }

    /// A monotone stretch in one band, with the scalar at its ends.
    fn leg(&mut self, passage: &Passage<'a>, (from, to): (f64, f64), (s0, s1): (f64, f64)) {
        let band = self.medium.band(self.medium.band_number(0.5 * (s0 + s1)));
        let (i0, i1) = (band.importance_at(s0), band.importance_at(s1));
        let Some(erasure) = self.erasure.filter(|_| i1 > i0 && i1 > self.importance) else {
            self.raise(i0);
            return self.pass(&passage.span((from, to), band));
        };
        let mut start = from;
        if i0 < self.importance {
            start = passage.scalar.crossing(from, to, band.scalar_where(self.importance)).clamp(from, to);
            self.pass(&passage.span((from, start), band));
        }
        self.raise(i0);
        self.rise(&passage.span((start, to), band), i1, erasure);
    }
}

impl Visitor for Accumulator<'_> {
    fn wants(&self, low: f64, high: f64) -> bool {
        let importance = if self.erasure.is_some() { self.importance } else { f64::INFINITY };
        !self.medium.is_idle_on(low, high, importance)
    }

    fn piece(&mut self, piece: &Piece) -> ControlFlow<()> {
        let medium = self.medium;
        let scalar = medium.scalar(&piece.value);
        let (low, high) = scalar.bounds();
        let (first, last) = (medium.band_number(low), medium.band_number(high));
        let band = medium.band(first);
        let in_one_band = first == last;
        let is_plain = self.erasure.is_none()
            || in_one_band && band.importance_at(low).max(band.importance_at(high)) <= self.importance;
        if in_one_band && is_plain && band.is_empty() {
            return ControlFlow::Continue(());
        }
        let shader = self.shading.map(|shading| Shader { shading, gradient: (piece.gradient)() });
        let passage = Passage { scalar, length_m: piece.t1 - piece.t0, shader };
        if in_one_band && is_plain {
            self.pass(&passage.span((0.0, 1.0), band));
        } else {
            let mut from = 0.0;
            for to in scalar.turning_points().chain([1.0]) {
                self.monotone(&passage, from, to);
                from = to;
            }
        }
        let remaining = self.may_still_change();
        if remaining < EXIT_SHARE * self.integrator.tolerance {
            self.state.error += remaining;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}
