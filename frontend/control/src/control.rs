//! The course of one configuration after the other: begin, refine, show, rest.
//!
//! A *configuration* is what rays see at one time. The *active* one is being cast, unit after unit; the *shown* one is on
//! the screens. After each tick all back-ends have cast the same units of the same configuration, and two errors are known
//! of the active one, means over all pixels of the display in linear colour:
//!
//! - ζ, in space: what may be wrong with its pixels that are not cast yet;
//! - τ, in time: how far the newest state is from it, told from a few rays of both.
//!
//! STE prints its rules with some signs turned; these are the ones that its text describes:
//!
//! ```text
//! restart  if something has changed, and μ(ρ) τa ≥ ζa or the active picture is complete
//! show     if μ(ϑ) (τs − τa) + (ζs − ζa) > 0, or a restart follows, or the active picture is complete
//! rest     if nothing has changed and the active picture is complete, or ζa < χ for a second at most
//! ```
//!
//! The paper restarts only while τa > 0. Here a complete picture gives way to whatever has changed: few rays may all miss
//! what is small. What the paper calls τ is a sum over all changes on the way, so that to and fro counts twice; here it is
//! the distance from the active picture to the newest, which a restart would bring.

use crate::rule::{Rule, weighed};
use std::time::Duration;

/// Refining may pause for so long, all pauses of a configuration together (STE section 4.3).
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

/// What detail that has come is taken to change, until some has: a lot, since a volume appears then.
const FIRST_DETAIL: f64 = 1.0 / 16.0;

/// What is new when a tick is due.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct News {
    /// Whether rays would see something else than the active configuration, as it was asked for.
    pub has_changed: bool,
    /// Whether back-ends have, or wait for, detail that the active configuration does not show.
    pub has_detail: bool,
}

/// What a tick does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Drops the active configuration, and casts the first units of the newest.
    Begin,
    /// Casts more units of the active one.
    Refine {
        /// Units that are cast already.
        from: u32,
    },
    /// Nothing.
    Rest,
}

/// What a tick found, means over all pixels of the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// Units of the active configuration that are cast now.
    pub done: u32,
    /// ζ of the active picture.
    pub spatial: f64,
    /// How far the newest state is from the active one; None if it is the same. After a tick that began one: how far that
    /// is from the one before; None if there was none.
    pub change: Option<f64>,
    /// What is new since the tick began.
    pub news: News,
}

/// The configuration that is being cast.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Active {
    began: Duration,
    /// Whether only detail has changed since the one before.
    is_for_detail: bool,
    done: u32,
    spatial: f64,
    temporal: f64,
    /// Whether a newer one is to begin.
    is_over: bool,
    paused: Duration,
    pausing_since: Option<Duration>,
}

/// What is on the screens.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    spatial: f64,
    /// How far the active configuration is from it; 0 if it is the same.
    lag: f64,
}

/// The control of a driven display.
#[derive(Clone, Debug)]
pub struct Control {
    rule: Rule,
    /// Units of a complete picture.
    units: u32,
    active: Option<Active>,
    shown: Option<Shown>,
    /// What detail changed when it was last shown.
    detail: f64,
}

impl Control {
    /// By a rule, for pictures of so many units.
    pub fn new(rule: Rule, units: u32) -> Self {
        Self { rule, units, active: None, shown: None, detail: FIRST_DETAIL }
    }

    /// What the tick that is due does. After anything but a rest [`Control::found`] has to follow.
    pub fn next(&mut self, news: News, now: Duration) -> Work {
        let Some(active) = &mut self.active else { return self.begin(news, now) };
        let is_new = news.has_changed || news.has_detail;
        if is_new && (active.is_over || active.done >= self.units) {
            return self.begin(news, now);
        }
        if active.done >= self.units {
            return Work::Rest;
        }
        if !is_new && self.rule.pauses(active.spatial) {
            let since = *active.pausing_since.get_or_insert(now);
            if active.paused + now.saturating_sub(since) < LONGEST_PAUSE {
                return Work::Rest;
            }
        }
        if let Some(since) = active.pausing_since.take() {
            active.paused += now.saturating_sub(since);
        }
        Work::Refine { from: active.done }
    }

    fn begin(&mut self, news: News, now: Duration) -> Work {
        self.active = Some(Active {
            began: now,
            is_for_detail: self.active.is_some() && !news.has_changed,
            done: 0,
            spatial: f64::INFINITY,
            temporal: 0.0,
            is_over: false,
            paused: Duration::ZERO,
            pausing_since: None,
        });
        Work::Begin
    }

    /// What a tick found. Whether what it made is shown.
    pub fn found(&mut self, found: Found, now: Duration) -> bool {
        let Some(active) = &mut self.active else { return false };
        if active.done == 0 {
            let change = found.change.unwrap_or(0.0);
            // What was given up for it is what is shown: nothing is given up unseen.
            if let Some(shown) = &mut self.shown {
                shown.lag = change;
            }
            if active.is_for_detail {
                self.detail = change;
            }
        } else {
            active.temporal = found.change.unwrap_or(0.0);
        }
        (active.done, active.spatial) = (found.done, found.spatial);
        let is_complete = active.done >= self.units;
        active.is_over = self.rule.gives_up(active, self.units, found.news, self.detail, now)
            || is_complete && (found.news.has_changed || found.news.has_detail);
        let shows = match &self.shown {
            None => true,
            Some(shown) => {
                is_complete || active.is_over || self.rule.prefers(active, shown, self.units, found.news, now)
            }
        };
        if shows {
            self.shown = Some(Shown { spatial: active.spatial, lag: 0.0 });
        }
        shows
    }

    /// ζ and τ of the active configuration; nothing is known before its first tick.
    pub fn errors(&self) -> Option<[f64; 2]> {
        self.active.map(|active| [active.spatial, active.temporal])
    }
}

impl Rule {
    /// Whether a picture is given up for a newer one.
    fn gives_up(&self, active: &Active, units: u32, news: News, detail: f64, now: Duration) -> bool {
        let is_new = news.has_changed || news.has_detail;
        match *self {
            Self::Errors(weights) => {
                let outweighs = |error: f64| error > 0.0 && weighed(weights.rho, error) >= active.spatial;
                (news.has_changed && outweighs(active.temporal)) || (news.has_detail && outweighs(detail))
            }
            Self::Rate { .. } | Self::Quality { .. } => is_new && self.is_reached(active, units, now),
        }
    }

    /// Whether a picture is shown in place of what is.
    fn prefers(&self, active: &Active, shown: &Shown, units: u32, news: News, now: Duration) -> bool {
        match *self {
            Self::Errors(weights) => {
                // τs − τa: the newest state is as far from what is shown as from the active one, and by what lies between.
                weighed(weights.theta, shown.lag) + (shown.spatial - active.spatial) > 0.0
            }
            Self::Rate { .. } | Self::Quality { .. } => {
                !news.has_changed && self.is_reached(active, units, now)
            }
        }
    }

    /// Whether a picture has what a fixed rule asks of it.
    fn is_reached(&self, active: &Active, units: u32, now: Duration) -> bool {
        match *self {
            Self::Errors(_) => false,
            Self::Rate { period } => now.saturating_sub(active.began) >= period,
            Self::Quality { share } => f64::from(active.done) >= share * f64::from(units),
        }
    }

    fn pauses(&self, spatial: f64) -> bool {
        matches!(*self, Self::Errors(weights) if spatial < weights.chi)
    }
}

#[cfg(test)]
#[path = "control_tests.rs"]
mod tests;
