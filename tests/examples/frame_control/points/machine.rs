//! The machine of `frontend::tune`, for anything that casts.

use super::painter::Painter;
use control::{Budget, Control, Found, News, Rule, Work};
use frontend::tune::{Footage, Machine, RATE_HZ};
use renderer::output::Picture;
use std::time::Duration;

// As in `frontend::tune`, to the bit: the study compares scores.
const OVERHEAD: Duration = Duration::from_millis(2);
const LEAD: Duration = Duration::from_millis(3);

/// Plays footage by a rule; `see` is given what the eye is shown at each instant.
pub fn play(
    footage: &Footage,
    painter: &mut dyn Painter,
    rule: Rule,
    machine: Machine,
    see: &mut dyn FnMut(usize, &Picture),
) {
    let period = Duration::from_secs_f64(1.0 / RATE_HZ);
    let control = Control::new(rule, painter.units());
    let mut player = Player { footage, machine, control, budget: Budget::of_time(period), active: None };
    let (mut now, mut next, mut picture) = (Duration::ZERO, 0, footage.truth(0).clone());
    while let Some(newest) = instant_at(footage, now) {
        let Some((end, shows)) = player.tick(painter, now, newest) else {
            now += period;
            continue;
        };
        now = end;
        if shows {
            let shown_at = ((now + LEAD).as_secs_f64() * RATE_HZ).ceil() as usize;
            (next..shown_at.min(footage.len())).for_each(|instant| see(instant, &picture));
            next = next.max(shown_at);
            picture = footage.eye(painter.pictures().into_iter());
        }
    }
    (next..footage.len()).for_each(|instant| see(instant, &picture));
}

/// The latest instant at a time; None after the last.
fn instant_at(footage: &Footage, now: Duration) -> Option<usize> {
    let instant = (now.as_secs_f64() * RATE_HZ + 1e-6) as usize;
    (instant < footage.len()).then_some(instant)
}

struct Player<'a> {
    footage: &'a Footage,
    machine: Machine,
    control: Control,
    budget: Budget,
    /// The instant that is cast, and how many units of it are.
    active: Option<(usize, u32)>,
}

impl Player<'_> {
    /// A tick: when it ends, and whether what it made is shown. None if it rests.
    fn tick(
        &mut self,
        painter: &mut dyn Painter,
        began: Duration,
        newest: usize,
    ) -> Option<(Duration, bool)> {
        let has_changed = self.active.is_none_or(|(active, _)| !self.footage.is_same(active, newest));
        let before = self.active;
        let (begins, from) = match self.control.next(News { has_changed, has_detail: false }, began) {
            Work::Rest => return None,
            Work::Begin => (true, 0),
            Work::Refine { from } => (false, from),
        };
        let active = if begins { newest } else { before.map_or(newest, |active| active.0) };
        let done = (from + self.budget.units()).min(painter.units());
        self.active = Some((active, done));
        let looks = !begins && has_changed;
        let cost = painter.cost(from, done) + if looks { painter.look() } else { 0.0 };
        let rays = self.machine.full.mul_f64(cost);
        self.budget.took(done - from + u32::from(looks), OVERHEAD + rays, rays);
        let now = began + OVERHEAD + rays;
        let change = match (begins, before) {
            (true, Some((before, _))) => Some(painter.change(active, before)),
            (false, _) if looks => Some(painter.change(newest, active)),
            _ => None,
        };
        if begins {
            painter.begin();
        }
        let spatial = painter.paint(active, done);
        let news = News { has_changed: looks, has_detail: false };
        Some((now, self.control.found(Found { done, spatial, change, news }, now)))
    }
}
