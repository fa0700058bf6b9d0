//! From one frame to the next.

use crate::cast::{DialKind, ToolId, VisitorId};
use crate::deed::Moment;
use crate::history::Before;
use crate::stage::{Handling, Phase, Window};
use crate::turn::{about_x, about_y};
use crate::world::World;
use glam::DVec3;
use std::time::Duration;

/// A dial that is out by less rests.
const DEAD_ZONE: f64 = 0.05;
/// A dial that rests for so long ends a deed.
const DIAL_RESTS: Duration = Duration::from_secs(1);
/// Nobody who does something is interrupted by the next item, unless it is twice due.
const UNDISTURBED: Duration = Duration::from_secs(10);

impl World {
    /// Time passes to this moment, not to one before the last. `home` is where the scene of an item has the volume's centre at
    /// a time of its script, metres, display frame.
    pub fn step(&mut self, moment: Moment, home: impl Fn(usize, f64) -> DVec3) {
        let before = self.moment.unwrap_or(moment);
        let moment = Moment { now: moment.now.max(before.now), seen_at: moment.seen_at.max(before.seen_at) };
        let passed_s = (moment.seen_at - before.seen_at).as_secs_f64();
        if self.moment.replace(moment).is_none() {
            (self.busy_at, self.item_began) = (moment.now, moment.now);
        }
        if !self.is_paused {
            self.stage.script_s += passed_s;
        }
        self.step_tools(moment);
        self.mark_menus();
        self.home_m = home(self.stage.item, self.stage.script_s);
        self.turn_dials(passed_s);
        self.move_held();
        self.move_window();
        self.limit_hold();
        if let Some(easing) = &self.easing {
            let (handling, has_arrived) = easing.at(moment.now);
            self.stage.handling = handling;
            self.easing = self.easing.take().filter(|_| !has_arrived);
        }
        self.tend(passed_s);
        self.home_m = home(self.stage.item, self.stage.script_s);
        self.stage.held_by = self.holding.as_ref().map(|holding| holding.visitor);
        self.stage.tools = self.shown_tools();
        self.stage.refusals = self.told_refusals();
    }

    fn step_tools(&mut self, moment: Moment) {
        let mut is_busy = self.holding.is_some();
        for place in 0..self.tools.len() {
            is_busy |= self.tools[place].step(moment);
            if self.tools[place].shown.is_none() {
                self.let_go(ToolId(place as u16));
            }
        }
        if is_busy {
            self.is_busy();
        }
    }

    fn turn_dials(&mut self, passed_s: f64) {
        for place in 0..self.tools.len() {
            let visitor = self.cast.holder(ToolId(place as u16));
            for number in 0..self.tools[place].dials.len() {
                let out = self.tools[place].dials[number];
                if out.abs() >= DEAD_ZONE {
                    self.is_busy();
                    let dial = self.cast.tools[place].dials[number];
                    self.turn_dial(visitor, dial.kind, out * dial.per_s * passed_s);
                }
            }
        }
    }

    fn turn_dial(&mut self, visitor: VisitorId, kind: DialKind, by: f64) {
        let Handling { mut turn, mut shift_m, mut scale } = self.stage.handling;
        let Window { mut shift, mut stretch } = self.stage.window;
        match kind {
            DialKind::TurnRight => turn = about_y(by) * turn,
            DialKind::TurnDown => turn = about_x(by) * turn,
            DialKind::MoveRight => shift_m.x += by,
            DialKind::MoveUp => shift_m.y += by,
            DialKind::MoveNear => shift_m.z += by,
            DialKind::Scale => scale *= libm::exp(by),
            DialKind::Shift => shift += by,
            DialKind::Stretch => stretch *= libm::exp(by),
        }
        let is_of_window = matches!(kind, DialKind::Shift | DialKind::Stretch);
        let held_by = match is_of_window {
            true => self.window_holding.map(|holding| self.cast.holder(holding.tool)),
            false => self.holding.as_ref().map(|holding| holding.visitor),
        };
        if held_by.is_some_and(|held_by| held_by != visitor) {
            return;
        }
        let now = self.now();
        let of_now = (visitor, is_of_window);
        if self.dialling.is_none_or(|(of, at)| of != of_now || now > at + DIAL_RESTS) {
            let before = match is_of_window {
                true => Before::Window(self.stage.window),
                false => Before::Handling(self.stage.handling),
            };
            self.history.push(visitor, before);
        }
        self.dialling = Some((of_now, now));
        if is_of_window {
            self.stage.window = Window { shift, stretch }.limited();
        } else {
            self.easing = None;
            self.stage.handling = self.limited(Handling { turn, shift_m, scale });
            self.regrip();
        }
    }

    /// What time does while nobody does anything.
    fn tend(&mut self, passed_s: f64) {
        let (now, is_held) = (self.now(), self.holding.is_some());
        let idle = now.saturating_sub(self.busy_at);
        if !self.is_undone && self.rules.undone_after.is_some_and(|after| idle >= after) {
            self.rest();
        }
        let attract = self.rules.attract.as_ref().filter(|attract| idle >= attract.after);
        if let Some(turn_per_s) = attract.map(|attract| attract.turn_per_s) {
            self.stage.phase = Phase::Attract;
            self.close_menus();
            if self.easing.is_none() {
                let turn = about_y(turn_per_s * passed_s) * self.stage.handling.turn;
                self.stage.handling.turn = turn.normalize();
            }
        }
        let Some(time) = self.item().time.filter(|_| self.programme.0.len() > 1) else { return };
        let shown_for = now.saturating_sub(self.item_began);
        let is_due = match self.stage.phase {
            Phase::Attract => shown_for >= time,
            Phase::Open if is_held => false,
            Phase::Open => (shown_for >= time && idle >= UNDISTURBED) || shown_for >= 2 * time,
        };
        if is_due {
            self.begin_item(self.next_item());
        }
    }
}
