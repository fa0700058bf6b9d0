//! The accumulation of light along one ray.

use super::band::Band;
use super::course::Course;
use super::enhancer::Chain;
use super::field::Levels;
use super::medium::{Erasure, Medium};
use super::passage::{Passage, Shown, Stretch};
use super::rise::{Emitter, Rise, State};
use super::{Piece, Radiance, Visitor};
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

/// What light is gathered from.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// How closely the model is followed.
    pub integrator: Integrator,
    /// The optics, as the chain leaves them.
    pub medium: &'a Medium,
    /// The chain of enhancers, prepared for the ray.
    pub chain: &'a Chain,
    /// Bounds every shaded colour component.
    pub brightest: f64,
    /// Of how many levels gradients are wanted.
    pub levels: Levels,
}

/// How far the light of a ray has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    state: State,
    /// ι_max.
    importance: f64,
}

impl Progress {
    /// Before anything was met.
    pub const START: Self =
        Self { state: State { rgb: DVec3::ZERO, opacity: 0.0, error: 0.0 }, importance: 0.0 };
}

/// A ray on its way: takes pieces, composites their spans exactly one after the other.
///
/// Each span's colour is wanted to `tolerance` per unit of its own opacity. Errors are hidden and erased as the light
/// is, so they add up to no more than `tolerance` times the ray's opacity.
pub struct Accumulator<'a> {
    scene: Scene<'a>,
    course: &'a Course,
    erasure: Option<Erasure>,
    state: State,
    importance: f64,
}

impl<'a> Accumulator<'a> {
    /// At the start of a ray, which sets out on `course`.
    pub fn new(scene: Scene<'a>, course: &'a Course) -> Self {
        Self::resuming(scene, course, Progress::START)
    }

    /// The light `progress` so far, going on along `course`.
    pub fn resuming(scene: Scene<'a>, course: &'a Course, progress: Progress) -> Self {
        Self {
            scene,
            course,
            erasure: scene.medium.erasure,
            state: progress.state,
            importance: progress.importance,
        }
    }

    /// What another accumulator needs to go on.
    pub fn progress(&self) -> Progress {
        Progress { state: self.state, importance: self.importance }
    }

    /// The same, without importance.
    pub fn without_importance(self) -> Self {
        Self { erasure: None, ..self }
    }

    /// What was seen so far.
    pub fn radiance(&self) -> Radiance {
        let State { rgb, opacity, error } = self.state;
        let reached = error <= self.scene.integrator.tolerance;
        Radiance { rgb, opacity: opacity.clamp(0.0, 1.0), error_estimate: error, reached }
    }

    /// Whether the rest of the ray changes too little to be looked at.
    pub fn is_finished(&self) -> bool {
        self.may_still_change() < EXIT_SHARE * self.scene.integrator.tolerance
    }

    /// A bound of what the rest of the ray may change.
    fn may_still_change(&self) -> f64 {
        let kept = self
            .erasure
            .filter(|e| e.largest > self.importance)
            .map_or(1.0, |e| e.kept(self.importance, e.largest));
        let open = 1.0 - kept * self.state.opacity;
        // What is erased of the past, and what is seen of the future.
        (open + (1.0 - kept)) * self.scene.brightest.max(1.0)
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
    fn pass(&mut self, shown: &Shown) {
        let Integrator { tolerance, max_depth } = self.scene.integrator;
        if shown.is_clear() {
            return;
        }
        if let Some(enhanced) = shown.enhanced() {
            return self.advance(&enhanced, None, 1.0);
        }
        let opacity = -(-shown.span.depth(1.0)).exp_m1();
        let emission = shown.span.whole_emission(opacity, 0.5 * tolerance * opacity, max_depth);
        let through = 1.0 - self.state.opacity;
        self.state.rgb += through * emission.value;
        self.state.opacity += through * opacity;
        self.state.error += through * emission.error;
    }

    /// A span on which importance rises from ι_max to `importance`.
    fn rise(&mut self, shown: &Shown, importance: f64, erasure: Erasure) {
        let kept = erasure.kept(self.importance, importance);
        if shown.is_clear() || kept <= 0.0 {
            // Nothing is added, or all that is added is erased before the end.
            self.raise(importance);
            return;
        }
        match shown.enhanced() {
            Some(enhanced) => self.advance(&enhanced, Some(erasure), kept),
            None => self.advance(&shown.span, Some(erasure), kept),
        }
        self.importance = importance;
    }

    /// Integrates a span step by step; `kept` of the light before it stays.
    fn advance(&mut self, emitter: &impl Emitter, erasure: Option<Erasure>, kept: f64) {
        let Integrator { tolerance, max_depth } = self.scene.integrator;
        let rise = Rise::new(emitter, erasure, 0.25 * tolerance);
        let before = State { error: 0.0, ..self.state };
        let after = rise.advance(before, 0.0, 1.0, max_depth);
        self.state = State { error: after.error + kept * self.state.error, ..after };
    }

    /// A stretch on which the scalar is monotone: it is cut at every knot.
    fn monotone(&mut self, stretch: &Stretch, from: f64, to: f64) {
        let (medium, scalar) = (self.scene.medium, &stretch.passage.scalar);
        let end = scalar.at(to);
        let (mut u, mut s) = (from, scalar.at(from));
        for knot in medium.knots_between(s, end) {
            let next = scalar.crossing(u, to, knot).clamp(u, to);
            self.leg(stretch, (u, next), (s, knot));
            (u, s) = (next, knot);
        }
        self.leg(stretch, (u, to), (s, end));
    }

    /// A monotone stretch in one band, with the scalar at its ends.
    fn leg(&mut self, stretch: &Stretch, (from, to): (f64, f64), (s0, s1): (f64, f64)) {
        let medium = self.scene.medium;
        let band =
            if s0 == s1 { medium.band_at(s0) } else { medium.band(medium.band_number(0.5 * (s0 + s1))) };
        let (i0, i1) = (band.importance_at(s0), band.importance_at(s1));
        let Some(erasure) = self.erasure.filter(|_| i1 > i0 && i1 > self.importance) else {
            self.raise(i0);
            return self.pass(&stretch.part((from, to), band));
        };
        let mut start = from;
        if i0 < self.importance {
            let level = band.scalar_where(self.importance);
            start = stretch.passage.scalar.crossing(from, to, level).clamp(from, to);
            self.pass(&stretch.part((from, start), band));
        }
        self.raise(i0);
        self.rise(&stretch.part((start, to), band), i1, erasure);
    }

    /// Composites a piece on which the scalar crosses no knot and raises no importance: all of it lies in `band`.
    fn pass_whole(&mut self, passage: &Passage, band: &Band) {
        self.stretches(passage, std::iter::empty(), |light, stretch, from, to| {
            light.pass(&stretch.part((from, to), band));
        });
    }

    /// Shows `take` the parts of a piece between the `cuts` and the chain's breaks.
    fn stretches(
        &mut self,
        passage: &Passage,
        cuts: impl Iterator<Item = f64>,
        take: impl Fn(&mut Self, &Stretch, f64, f64),
    ) {
        let Scene { chain, medium, .. } = self.scene;
        let shader = passage.shader();
        let mut ends: Vec<f64> = cuts.chain(passage.breaks(chain)).chain([1.0]).collect();
        ends.sort_by(f64::total_cmp);
        let mut from = 0.0;
        for to in ends {
            let zones = passage.zones(chain, from, to);
            take(self, &Stretch { passage, shader: shader.as_ref(), medium, chain, zones }, from, to);
            from = to;
        }
    }
}

impl Visitor for Accumulator<'_> {
    fn wants(&self, low: f64, high: f64) -> bool {
        let importance = if self.erasure.is_some() { self.importance } else { f64::INFINITY };
        !self.scene.medium.is_idle_on(low, high, importance)
    }

    fn levels(&self) -> Levels {
        self.scene.levels
    }

    fn piece(&mut self, piece: &Piece) -> ControlFlow<()> {
        let medium = self.scene.medium;
        let scalar = medium.scalar(&piece.value);
        let (low, high) = scalar.bounds();
        let (first, last) = (medium.band_number(low), medium.band_number(high));
        let band = if low == high { medium.band_at(low) } else { medium.band(first) };
        let spread = medium.spread(piece.deviation);
        if let Some(half) = spread.map(|spread| spread.bounds().1) {
            let (least, most) = (low - half, high + half);
            if self.erasure.is_none() && medium.is_clear_on(least, most) {
                return ControlFlow::Continue(());
            }
        }
        let in_one_band = first == last && spread.is_none();
        let is_plain = self.erasure.is_none()
            || in_one_band && band.importance_at(low).max(band.importance_at(high)) <= self.importance;
        if in_one_band && is_plain && band.is_empty() {
            return ControlFlow::Continue(());
        }
        let passage = Passage::new(piece, (scalar, spread), self.course, self.scene.levels);
        if in_one_band && is_plain {
            self.pass_whole(&passage, band);
        } else {
            let turns = passage.scalar.turning_points();
            self.stretches(&passage, turns, |light, stretch, from, to| light.monotone(stretch, from, to));
        }
        if self.is_finished() {
            self.state.error += self.may_still_change();
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}
