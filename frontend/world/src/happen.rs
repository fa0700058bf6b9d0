//! What an input reports, done to the world.

use crate::cast::{Action, ToolId};
use crate::history::Before;
use crate::stage::Handling;
use crate::world::{TO_BEFORE, World};
use inputs::{Event, What};

impl World {
    pub(crate) fn apply_event(&mut self, event: &Event) {
        match &event.what {
            What::Pose { sensor, pose } => {
                let here = (event.source, *sensor);
                if pose.is_some() && !self.tools.iter().any(|tool| tool.sensor() == Some(here)) {
                    let free = self.tools.iter_mut().find(|tool| tool.sensor().is_none());
                    free.into_iter().for_each(|tool| tool.bind(event.source, *sensor));
                }
                for (state, tool) in self.tools.iter_mut().zip(&self.cast.tools) {
                    if state.sensor() == Some(here) {
                        state.push(tool, event.measured(), *pose);
                    }
                }
            }
            What::Button { index, is_down } => self.apply_button(event, *index, *is_down),
            What::Axis { index, value } => {
                for (state, tool) in self.tools.iter_mut().zip(&self.cast.tools) {
                    let is_own = state.is_of(event.source);
                    for (out, dial) in state.dials.iter_mut().zip(&tool.dials) {
                        if is_own && dial.index == *index {
                            *out = if value.is_finite() { value.clamp(-1.0, 1.0) } else { 0.0 };
                        }
                    }
                }
            }
            What::Found(_) => {}
            What::Lost(_) => {
                for place in 0..self.tools.len() {
                    if self.tools[place].is_of(event.source) {
                        self.tools[place].down.clear();
                        self.tools[place].dials.fill(0.0);
                        self.let_go(ToolId(place as u16));
                    }
                }
            }
        }
    }

    fn apply_button(&mut self, event: &Event, index: u8, is_down: bool) {
        for place in 0..self.tools.len() {
            if !self.tools[place].is_of(event.source) {
                continue;
            }
            let changes = match is_down {
                true => self.tools[place].down.insert(index),
                false => self.tools[place].down.remove(&index),
            };
            let action = self.cast.tools[place].buttons.iter().find(|button| button.index == index);
            let (Some(action), true) = (action.map(|button| button.action), changes) else { continue };
            let tool = ToolId(place as u16);
            if is_down {
                self.is_busy();
                self.press(tool, action);
            } else {
                self.release(tool, action);
            }
        }
    }

    fn press(&mut self, tool: ToolId, action: Action) {
        let visitor = self.cast.holder(tool);
        match action {
            Action::Grab => self.grab(tool),
            Action::Window => self.hold_window(tool),
            Action::Menu => self.open_menu(tool),
            Action::PickBand => self.open_bands(tool),
            Action::NextKind => {
                let place = usize::from(tool.0);
                let kinds = self.cast.tools[place].kinds.len().max(1);
                self.become_kind(tool, (self.tools[place].kind + 1) % kinds);
            }
            Action::NextLook | Action::PreviousLook => {
                if let Some(look) = self.look_beside(action == Action::NextLook) {
                    self.show_look(visitor, Some(look));
                }
            }
            Action::NextBand => self.next_band(visitor),
            Action::NextPreset => self.next_preset(visitor),
            Action::Undo => self.undo(visitor),
            Action::Reset => {
                if self.may_move(visitor) {
                    self.history.push(visitor, Before::Handling(self.stage.handling));
                    self.ease(Handling::default(), TO_BEFORE);
                    self.forget_looks();
                }
            }
            Action::NextItem => self.show_item(visitor, self.next_item()),
        }
    }

    fn release(&mut self, tool: ToolId, action: Action) {
        match action {
            Action::Grab => self.let_go_of_volume(tool),
            Action::Window => {
                self.window_holding = self.window_holding.filter(|holding| holding.tool != tool);
            }
            Action::Menu => self.choose(tool, false),
            Action::PickBand => self.choose(tool, true),
            _ => {}
        }
    }
}
