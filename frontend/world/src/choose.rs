//! How visitors open menus, mark what they want, and choose it.

use crate::cast::{ToolId, ToolKind, VisitorId};
use crate::choices::choices;
use crate::menu::{Choice, Menu, Trial};
use crate::stage::Refusal;
use crate::world::World;

impl World {
    /// A tool's holder wants to see what they can do.
    pub(crate) fn open_menu(&mut self, tool: ToolId) {
        let of = &self.cast.tools[usize::from(tool.0)];
        let mut groups = choices(of, self.item(), self.programme.0.len());
        groups.iter_mut().for_each(|group| group.retain(|&choice| !self.is_so(tool, choice)));
        self.show_menu(tool, &groups, None);
    }

    /// They want to see the bands, and try them out.
    pub(crate) fn open_bands(&mut self, tool: ToolId) {
        let visitor = self.cast.holder(tool);
        let mut kinds = self.cast.tools[usize::from(tool.0)].kinds.iter();
        let (picks, is_there) = (kinds.any(|&kind| kind.picks_band()), self.hand_of(tool).is_some());
        if picks && is_there && self.menu_of(tool).is_none() && self.may_pick_band(visitor) {
            self.end_trial();
            let bands = (0..self.item().bands).map(Choice::Band).collect();
            let trial = Trial { before: self.stage.band, since: self.now() };
            self.show_menu(tool, &[bands], Some(trial));
        }
    }

    /// Opens a menu at the tip of a tool that has none.
    fn show_menu(&mut self, tool: ToolId, groups: &[Vec<Choice>], trial: Option<Trial>) {
        let Some(hand) = self.hand_of(tool).filter(|_| self.menu_of(tool).is_none()) else { return };
        let menu = Menu::new(tool, hand.tip_m, groups, &self.menu_size);
        self.stage.menus.extend(menu.map(|menu| Menu { trial, ..menu }));
        self.stage.menus.sort_by_key(|menu| menu.tool);
    }

    fn menu_of(&self, tool: ToolId) -> Option<&Menu> {
        self.stage.menus.iter().find(|menu| menu.tool == tool)
    }

    /// Whether a choice would change nothing.
    fn is_so(&self, tool: ToolId, choice: Choice) -> bool {
        match choice {
            Choice::Undo => !self.history.has_deed_of(self.cast.holder(tool)),
            Choice::Kind(kind) => self.kind_of(tool) == kind,
            Choice::Look(look) => self.shown_look() == look,
            Choice::Preset(preset) => {
                let preset = &self.item().presets[preset];
                self.is_at(preset) && self.stage.look == preset.look
            }
            Choice::Item(item) => self.stage.item == item,
            Choice::Band(band) => self.stage.band == Some(band),
        }
    }

    fn kind_of(&self, tool: ToolId) -> ToolKind {
        let place = usize::from(tool.0);
        self.tools[place].kind_of(&self.cast.tools[place])
    }

    /// Tips mark what they are over; a band that is marked is tried out.
    pub(crate) fn mark_menus(&mut self) {
        let mut is_changed = false;
        for menu in &mut self.stage.menus {
            if let Some((hand, _)) = self.tools[usize::from(menu.tool.0)].shown {
                is_changed |= menu.mark(hand.tip_m);
            }
            if let Some(trial) = menu.trial {
                let marked = menu.choice().and_then(|choice| match choice {
                    Choice::Band(band) => Some(band),
                    _ => None,
                });
                self.stage.band = marked.or(trial.before);
            }
        }
        if is_changed {
            self.is_busy();
        }
    }

    /// The button is released that opened a tool's menu, or its list of bands: what is marked is chosen.
    pub(crate) fn choose(&mut self, tool: ToolId, is_of_bands: bool) {
        let menu = self.menu_of(tool).filter(|menu| menu.trial.is_some() == is_of_bands);
        let Some(choice) = menu.map(Menu::choice) else { return };
        self.is_busy();
        self.close_menu(tool);
        let visitor = self.cast.holder(tool);
        match choice.filter(|&choice| !self.is_so(tool, choice)) {
            None => {}
            Some(Choice::Undo) => self.undo(visitor),
            Some(Choice::Kind(kind)) => {
                let kinds = &self.cast.tools[usize::from(tool.0)].kinds;
                let kind = kinds.iter().position(|&known| known == kind);
                kind.into_iter().for_each(|kind| self.become_kind(tool, kind));
            }
            Some(Choice::Look(look)) => self.show_look(visitor, look),
            Some(Choice::Preset(preset)) => self.go_to_preset(visitor, preset),
            Some(Choice::Item(item)) => self.show_item(visitor, item),
            Some(Choice::Band(band)) => self.show_band(visitor, Some(band)),
        }
    }

    /// A tool's menu closes, and nothing is chosen: of bands, that from before comes back.
    pub(crate) fn close_menu(&mut self, tool: ToolId) {
        let trial = self.menu_of(tool).and_then(|menu| menu.trial);
        self.stage.menus.retain(|menu| menu.tool != tool);
        if let Some(trial) = trial {
            self.stage.band = trial.before;
        }
    }

    /// All do.
    pub(crate) fn close_menus(&mut self) {
        self.end_trial();
        self.stage.menus.clear();
    }

    /// Nobody tries a band out any more; that from before comes back.
    pub(crate) fn end_trial(&mut self) {
        if let Some((tool, _)) = self.trial() {
            self.close_menu(tool);
        }
    }

    fn trial(&self) -> Option<(ToolId, Trial)> {
        self.stage.menus.iter().find_map(|menu| Some((menu.tool, menu.trial?)))
    }

    /// Whether a visitor may change the band; if not, they are told who tries one out. Whoever has done that for too long gives
    /// way.
    pub(crate) fn may_pick_band(&mut self, visitor: VisitorId) -> bool {
        let Some((tool, trial)) = self.trial() else { return true };
        let held_by = self.cast.holder(tool);
        let held_for = self.now().saturating_sub(trial.since);
        let is_over = self.rules.longest_hold.is_some_and(|longest| held_for >= longest);
        if held_by == visitor {
            return true;
        }
        if is_over {
            self.close_menu(tool);
        } else {
            self.refuse(Refusal::Held { wanted_by: visitor, held_by });
        }
        is_over
    }
}
