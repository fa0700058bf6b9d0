//! What visitors do to the stage, whether they ask for it by a button or in a menu.

use crate::cast::{ToolId, VisitorId};
use crate::history::{Before, NoUndo};
use crate::programme::Preset;
use crate::stage::{Refusal, Window};
use crate::world::{TO_BEFORE, World};
use std::time::Duration;

/// How long a volume takes to a placement that somebody prepared.
const TO_PRESET: Duration = Duration::from_millis(600);

impl World {
    /// A tool becomes another of its kinds.
    pub(crate) fn become_kind(&mut self, tool: ToolId, kind: usize) {
        let visitor = self.cast.holder(tool);
        self.history.push(visitor, Before::Kind(tool, self.tools[usize::from(tool.0)].kind));
        self.take_kind(tool, kind);
    }

    /// A tool that is another has another menu.
    fn take_kind(&mut self, tool: ToolId, kind: usize) {
        self.close_menu(tool);
        self.tools[usize::from(tool.0)].kind = kind;
    }

    /// The look that follows, or that before; None where there are none.
    pub(crate) fn look_beside(&self, onward: bool) -> Option<usize> {
        let looks = self.item().looks;
        let last = looks.checked_sub(1)?;
        let (step, first) = if onward { (1, 0) } else { (last, last) };
        Some(self.stage.look.map_or(first, |look| (look + step) % looks))
    }

    /// The look that is shown, from 0 among the item's looks; None where it is the item's own and that is none of these.
    pub(crate) fn shown_look(&self) -> Option<usize> {
        self.stage.look.or(self.item().own_look)
    }

    /// A visitor wants to see another look.
    pub(crate) fn show_look(&mut self, visitor: VisitorId, look: Option<usize>) {
        if self.may_change_look(visitor) {
            self.history.push(visitor, Before::Look(self.stage.look, self.stage.window));
            self.take_look(look);
        }
    }

    /// A look has a window of its own.
    pub(crate) fn take_look(&mut self, look: Option<usize>) {
        (self.stage.look, self.stage.window, self.window_holding) = (look, Window::default(), None);
    }

    /// Another band, of which may be said that the visitor may pick it.
    pub(crate) fn show_band(&mut self, visitor: VisitorId, band: Option<usize>) {
        self.history.push(visitor, Before::Band(self.stage.band));
        self.stage.band = band;
    }

    /// A visitor wants the band that follows.
    pub(crate) fn next_band(&mut self, visitor: VisitorId) {
        if self.may_pick_band(visitor) {
            self.end_trial();
            let (bands, band) = (self.item().bands, self.stage.band);
            self.show_band(visitor, (bands > 0).then(|| band.map_or(0, |band| (band + 1) % bands)));
        }
    }

    /// Whether the volume is where a preset has it, or on its way there.
    pub(crate) fn is_at(&self, preset: &Preset) -> bool {
        self.aim() == self.limited(preset.handling)
    }

    /// A visitor wants the preset that follows.
    pub(crate) fn next_preset(&mut self, visitor: VisitorId) {
        let presets = &self.item().presets;
        let here = presets.iter().position(|preset| self.is_at(preset));
        if !presets.is_empty() {
            self.go_to_preset(visitor, here.map_or(0, |here| (here + 1) % presets.len()));
        }
    }

    /// A visitor wants one of the presets.
    pub(crate) fn go_to_preset(&mut self, visitor: VisitorId, preset: usize) {
        let Preset { handling, look, .. } = self.item().presets[preset];
        if !self.may_move(visitor) || !self.may_change_look(visitor) {
            return;
        }
        self.history.push(visitor, Before::Look(self.stage.look, self.stage.window));
        self.history.push(visitor, Before::Handling(self.stage.handling));
        self.ease(handling, TO_PRESET);
        if look != self.stage.look {
            (self.stage.look, self.stage.window) = (look, Window::default());
        }
    }

    /// A visitor wants one of the items.
    pub(crate) fn show_item(&mut self, visitor: VisitorId, item: usize) {
        if self.may_move(visitor) {
            self.begin_item(item);
        }
    }

    /// A visitor wants their latest deed undone.
    pub(crate) fn undo(&mut self, visitor: VisitorId) {
        // Whoever holds something has it.
        if !self.may_move(visitor) || !self.may_change_look(visitor) || !self.may_pick_band(visitor) {
            return;
        }
        match self.history.undo(visitor) {
            Ok(Before::Handling(handling)) => self.ease(handling, TO_BEFORE),
            Ok(Before::Look(look, window)) => (self.stage.look, self.stage.window) = (look, window),
            Ok(Before::Window(window)) => self.stage.window = window,
            Ok(Before::Band(band)) => {
                self.end_trial();
                self.stage.band = band;
            }
            Ok(Before::Kind(tool, kind)) => self.take_kind(tool, kind),
            Err(NoUndo::Nothing) => {}
            Err(NoUndo::ChangedBy(changed_by)) => {
                self.refuse(Refusal::ChangedSince { wanted_by: visitor, changed_by });
            }
        }
    }
}
