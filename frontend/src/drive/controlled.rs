//! What back-ends cast next, and whether it is shown, by frame control.

use crate::report::plot::StripTick;
use control::{Budget, Control, Found, News, Rule, Work};
use protocol::{Caster, FrameReport, FrameState, Refined, Refinement};
use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;

/// Ticks that are kept for the strip.
const MOST_TICKS: usize = 4000;
/// Units that a picture begins with where whole rows are cast: every eighth row, as of single pixels the first unit has. With
/// fewer it is all streaks.
const FIRST_UNITS_OF_ROWS: u32 = 8;
/// A change that nobody could measure is as large as any.
const ALL: f64 = 1.0;

/// What back-ends are asked for.
#[derive(Clone, Debug)]
pub struct Task {
    /// The frame.
    pub frame: FrameState,
    /// What it is compared with.
    pub newest: Option<FrameState>,
    /// When what it shows was asked of the inputs.
    pub asked_at: Duration,
}

/// A tick under way.
#[derive(Clone, Debug)]
struct Tick {
    number: u32,
    begins: bool,
    looks: bool,
    /// Units that it casts, a look at the newest state included; 0 where only marks have changed.
    units: u32,
    done: u32,
    refined: Vec<Refined>,
    /// What the slowest back-end took, and for how long of that it cast rays.
    slowest: [Duration; 2],
}

/// The configuration that is being cast.
#[derive(Clone, Debug)]
struct Active {
    state: FrameState,
    asked_at: Duration,
    done: u32,
    has_detail: bool,
}

/// What a report says of frame control.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ControlSummary {
    /// Ticks in which rays were cast.
    pub ticks: u64,
    /// Pictures that were begun.
    pub begun: u64,
    /// Of these because of detail that came.
    pub begun_for_detail: u64,
    /// Pictures that were shown, each time they were.
    pub shown: u64,
    /// Of these complete ones.
    pub shown_complete: u64,
    /// The mean share of rays in what was shown.
    pub mean_share: f64,
    /// The means of ζ and τ over the ticks, linear colour.
    pub mean_errors: [f64; 2],
    /// The mean share of the display's periods in which nothing was cast.
    pub idle_share: f64,
}

/// Frame control of a driven display.
#[derive(Clone, Debug)]
pub struct Controlled {
    control: Control,
    budget: Budget,
    configuration: u32,
    /// Units that a picture begins with, at least.
    first_units: u32,
    active: Option<Active>,
    tick: Option<Tick>,
    ticks: VecDeque<StripTick>,
    summary: ControlSummary,
    sums: [f64; 3],
    /// Periods in which something was due, and those in which nothing was.
    periods: [u64; 2],
}

impl Controlled {
    /// By a rule, with as many units in a tick as a budget allows.
    pub fn new(rule: Rule, budget: Budget) -> Self {
        Self {
            control: Control::new(rule, Refinement::UNITS),
            budget,
            configuration: 0,
            first_units: 1,
            active: None,
            tick: None,
            ticks: VecDeque::new(),
            summary: ControlSummary::default(),
            sums: [0.0; 3],
            periods: [0; 2],
        }
    }

    /// What is cast in the tick that is due; None where there is nothing to do. `welcomes_planes` is asked where a picture
    /// is begun: all of it is cast alike.
    pub fn next(
        &mut self,
        newest: FrameState,
        now: Duration,
        welcomes_planes: impl FnOnce() -> bool,
    ) -> Option<Task> {
        let number = newest.index;
        let news = News {
            has_changed: self.active.as_ref().is_none_or(|active| !active.state.is_seen_as(&newest)),
            has_detail: self.active.as_ref().is_some_and(|active| active.has_detail),
        };
        let work = self.control.next(news, now);
        self.periods[usize::from(work == Work::Rest)] += 1;
        let from = match work {
            Work::Begin => {
                self.configuration += 1;
                let state = FrameState { welcomes_planes: welcomes_planes(), ..newest.clone() };
                self.active = Some(Active { state, asked_at: now, done: 0, has_detail: false });
                self.summary.begun += 1;
                self.summary.begun_for_detail += u64::from(!news.has_changed);
                0
            }
            Work::Refine { from } => from,
            Work::Rest => return self.draw_marks(newest),
        };
        let active = self.active.as_mut()?;
        let least = if work == Work::Begin { self.first_units } else { 1 };
        let done = (from + self.budget.units().max(least)).min(Refinement::UNITS);
        let looks = work != Work::Begin && news.has_changed;
        active.state.marks = newest.marks.clone();
        active.done = done;
        let frame = part(&active.state, number, self.configuration, done);
        let asked_at = active.asked_at;
        let units = done - from + u32::from(looks);
        let (begins, refined) = (work == Work::Begin, Vec::new());
        self.tick = Some(Tick { number, begins, looks, units, done, refined, slowest: Default::default() });
        self.summary.ticks += 1;
        // What casts it is what casts the picture.
        let welcomes_planes = frame.welcomes_planes;
        let newest =
            looks.then_some(FrameState { sub_frame: None, refinement: None, welcomes_planes, ..newest });
        Some(Task { frame, newest, asked_at })
    }

    /// Where rays have nothing to do, marks may have moved.
    fn draw_marks(&mut self, newest: FrameState) -> Option<Task> {
        let active = self.active.as_mut().filter(|active| active.state.marks != newest.marks)?;
        active.state.marks = newest.marks;
        let frame = part(&active.state, newest.index, self.configuration, active.done);
        let (number, done) = (newest.index, active.done);
        let tick = Tick {
            number,
            done,
            begins: false,
            looks: false,
            units: 0,
            refined: Vec::new(),
            slowest: Default::default(),
        };
        self.tick = Some(tick);
        Some(Task { frame, newest: None, asked_at: active.asked_at })
    }

    /// A back-end has drawn a frame.
    pub fn drawn(&mut self, report: &FrameReport) {
        let Some(tick) = self.tick.as_mut().filter(|tick| tick.number == report.frame) else { return };
        let has_rows = matches!(report.caster, Caster::Planes { .. });
        self.first_units = if has_rows { FIRST_UNITS_OF_ROWS } else { 1 };
        let seconds = |ms: f64| Duration::from_secs_f64(ms.max(0.0) / 1e3);
        tick.slowest = tick.slowest.max([report.total_ms, report.stages.cast_ms].map(seconds));
        tick.refined.extend(report.refined);
    }

    /// Units that a frame casts, for who compares how long frames take.
    pub fn units_of(&self, frame: u32) -> Option<u32> {
        self.tick.as_ref().filter(|tick| tick.number == frame && tick.units > 0).map(|tick| tick.units)
    }

    /// All back-ends that are waited for have drawn the frame. Whether it is shown.
    pub fn finished(&mut self, now: Duration) -> bool {
        let Some(tick) = self.tick.take() else { return false };
        if tick.units == 0 {
            return true;
        }
        let [total, casting] = tick.slowest;
        self.budget.took(tick.units, total, casting);
        let sum = |of: fn(&Refined) -> u64| tick.refined.iter().map(of).sum::<u64>();
        let mean =
            |sum: u64, count: u64| (count > 0).then(|| sum as f64 / Refined::UNIT as f64 / count as f64);
        let spatial = mean(sum(|one| one.spatial), sum(|one| one.pixels)).unwrap_or(ALL);
        let change = mean(sum(|one| one.change), sum(|one| one.compared)).or(tick.looks.then_some(ALL));
        let has_detail = tick.refined.iter().any(|one| one.has_detail);
        if let Some(active) = &mut self.active {
            active.has_detail = has_detail;
        }
        let news = News { has_changed: tick.looks, has_detail };
        let shows = self.control.found(Found { done: tick.done, spatial, change, news }, now);
        self.note(&tick, shows, now);
        shows
    }

    fn note(&mut self, tick: &Tick, shows: bool, now: Duration) {
        let errors = self.control.errors().unwrap_or_default();
        let share = f64::from(tick.done) / f64::from(Refinement::UNITS);
        if shows {
            self.summary.shown += 1;
            self.summary.shown_complete += u64::from(tick.done == Refinement::UNITS);
            self.sums[2] += share;
        }
        (0..2).for_each(|i| self.sums[i] += if errors[i].is_finite() { errors[i] } else { 0.0 });
        if self.ticks.len() == MOST_TICKS {
            self.ticks.pop_front();
        }
        self.ticks.push_back(StripTick {
            at_s: now.as_secs_f64(),
            share,
            errors: errors.map(|error| 255.0 * error),
            begins: tick.begins,
            shows,
        });
    }

    /// What a report says of it.
    pub fn summary(&self) -> ControlSummary {
        let per_tick = |sum: f64| sum / self.summary.ticks.max(1) as f64;
        let [busy, idle] = self.periods.map(|periods| periods as f64);
        ControlSummary {
            mean_share: self.sums[2] / self.summary.shown.max(1) as f64,
            mean_errors: [per_tick(self.sums[0]), per_tick(self.sums[1])],
            idle_share: idle / (busy + idle).max(1.0),
            ..self.summary.clone()
        }
    }

    /// How it goes, for a line on a terminal.
    pub fn line(&self) -> String {
        let Some(tick) = self.ticks.back() else { return String::new() };
        let [spatial, temporal] = tick.errors;
        let ControlSummary { begun, shown, .. } = self.summary;
        format!(
            ", {:.0} % cast, ζ {spatial:.2}, τ {temporal:.2} of 255, {begun} begun, {shown} shown",
            100.0 * tick.share
        )
    }

    /// The latest ticks, for a strip.
    pub fn ticks(&self) -> Vec<StripTick> {
        self.ticks.iter().copied().collect()
    }
}

/// A part of the way to a picture.
fn part(state: &FrameState, index: u32, configuration: u32, to: u32) -> FrameState {
    let refinement = Some(Refinement { configuration, to });
    FrameState { index, sub_frame: None, refinement, ..state.clone() }
}

#[cfg(test)]
#[path = "controlled_tests.rs"]
mod tests;
