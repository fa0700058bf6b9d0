//! How visitors take hold of the volume and of its window of values, and let go.

use crate::cast::ToolId;
use crate::grip::{Body, Grip, Hand};
use crate::history::Before;
use crate::holding::{Holding, WindowHolding};
use crate::stage::{Refusal, Window};
use crate::world::World;

/// A hand that moves by so much shifts the values by the width of the domain, or stretches them by a factor of e, metres.
const PER_WINDOW_M: f64 = 0.5;

impl World {
    pub(crate) fn hand_of(&self, tool: ToolId) -> Option<Hand> {
        self.tools[usize::from(tool.0)].shown.map(|shown| shown.0)
    }

    /// The grip of these tools on the volume as it is now.
    fn grip_of(&self, tools: &[ToolId]) -> Option<Grip> {
        let body = self.body();
        match *tools {
            [one] => Some(Grip::One(self.hand_of(one)?, body)),
            [one, other] => Some(Grip::Two([self.hand_of(one)?, self.hand_of(other)?], body)),
            _ => None,
        }
    }

    /// A tool wants to hold the volume.
    pub(crate) fn grab(&mut self, tool: ToolId) {
        let visitor = self.cast.holder(tool);
        let Some(hand) = self.hand_of(tool) else { return };
        match &self.holding {
            Some(holding) if holding.visitor != visitor => {
                let held_by = holding.visitor;
                self.refuse(Refusal::Held { wanted_by: visitor, held_by });
                if !self.waiting.contains(&tool) {
                    self.waiting.push(tool);
                }
            }
            Some(holding) => {
                if let ([first], false) = (&holding.tools[..], holding.is_by(tool)) {
                    let tools = vec![*first, tool];
                    let (since, grip) = (holding.since, self.grip_of(&tools));
                    self.holding = grip.map(|grip| Holding { visitor, tools, grip, since });
                }
            }
            None => {
                self.history.push(visitor, Before::Handling(self.stage.handling));
                self.easing = None;
                let (grip, since) = (Grip::One(hand, self.body()), self.now());
                self.holding = Some(Holding { visitor, tools: vec![tool], grip, since });
            }
        }
    }

    /// A tool lets go of the volume; another that held it as well goes on.
    pub(crate) fn let_go_of_volume(&mut self, tool: ToolId) {
        self.waiting.retain(|&waiting| waiting != tool);
        let Some(mut holding) = self.holding.take() else { return };
        if holding.is_by(tool) {
            holding.tools.retain(|&held| held != tool);
            self.holding = self.grip_of(&holding.tools).map(|grip| Holding { grip, ..holding });
        } else {
            self.holding = Some(holding);
        }
    }

    /// A tool lets go of everything, and nothing is chosen with it.
    pub(crate) fn let_go(&mut self, tool: ToolId) {
        self.close_menu(tool);
        self.let_go_of_volume(tool);
        self.window_holding = self.window_holding.filter(|holding| holding.tool != tool);
    }

    /// The volume was moved otherwise: who holds it holds it where it is now.
    pub(crate) fn regrip(&mut self) {
        if let Some(holding) = self.holding.take() {
            self.holding = self.grip_of(&holding.tools).map(|grip| Holding { grip, ..holding });
        }
    }

    /// The volume goes with the hands that hold it.
    pub(crate) fn move_held(&mut self) {
        let Some(holding) = &self.holding else { return };
        let hands: Vec<Hand> = holding.tools.iter().filter_map(|&tool| self.hand_of(tool)).collect();
        let body: Body = match (&holding.grip, &hands[..]) {
            (Grip::One(began, body), [now]) => Grip::moved_by_one(began, body, now),
            (Grip::Two(began, body), &[one, other]) => {
                Grip::moved_by_two(began, body, &[one, other], self.rules.scales)
            }
            _ => return,
        };
        self.stage.handling = self.limited(body.handling(self.home_m));
    }

    /// Whoever has held the volume for too long gives it to one who waits.
    pub(crate) fn limit_hold(&mut self) {
        let (Some(limit), Some(holding)) = (self.rules.longest_hold, &self.holding) else { return };
        let is_over = self.now().saturating_sub(holding.since) >= limit;
        if is_over && !self.waiting.is_empty() {
            let next = self.waiting.remove(0);
            self.holding = None;
            self.grab(next);
        }
    }

    /// A tool wants to move the window of values.
    pub(crate) fn hold_window(&mut self, tool: ToolId) {
        let visitor = self.cast.holder(tool);
        let Some(began) = self.hand_of(tool) else { return };
        if self.window_holding.is_none_or(|holding| holding.tool != tool) && self.may_change_look(visitor) {
            let window = self.stage.window;
            self.history.push(visitor, Before::Window(window));
            self.window_holding = Some(WindowHolding { tool, began, window });
        }
    }

    /// The window goes with the hand that holds it.
    pub(crate) fn move_window(&mut self) {
        let Some(WindowHolding { tool, began, window }) = self.window_holding else { return };
        let Some(now) = self.hand_of(tool) else { return };
        let moved = (now.tip_m - began.tip_m) / PER_WINDOW_M;
        let moved = Window { shift: window.shift + moved.x, stretch: window.stretch * libm::exp(moved.y) };
        self.stage.window = moved.limited();
    }
}
