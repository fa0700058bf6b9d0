//! What a world is, whatever visitors do.

use crate::cast::VisitorId;
use crate::history::MOST_DEEDS;
use crate::menu::{Choice, Menu};
use crate::stage::Handling;
use crate::world::World;

/// What rounding may make of a length.
const ROUNDING: f64 = 1e-12;

/// Tools that may wait for the volume.
const MOST_WAITING: usize = 6;

impl World {
    /// The laws that it is against: none, unless this program has an error.
    pub fn faults(&self) -> Vec<&'static str> {
        let (stage, item) = (self.stage(), self.item());
        let Handling { turn, shift_m, scale } = stage.handling;
        let (least, most) = self.rules.scales;
        let holders: Vec<VisitorId> =
            stage.tools.iter().filter(|tool| tool.grabs).map(|tool| self.cast.holder(tool.tool)).collect();
        let is_sorted = stage.tools.windows(2).all(|pair| pair[0].tool < pair[1].tool);
        let laws = [
            ("all is finite", turn.is_finite() && shift_m.is_finite() && scale.is_finite()),
            ("a turn has length 1", (turn.length() - 1.0).abs() < ROUNDING),
            ("sizes keep their limits", (least..=most).contains(&scale)),
            ("places keep their limit", shift_m.length() <= self.rules.farthest_m * (1.0 + ROUNDING)),
            ("the item is there", stage.item < self.programme.0.len()),
            ("the look is there", stage.look.is_none_or(|look| look < item.looks.max(2))),
            ("the band is there", stage.band.is_none_or(|band| band < item.bands)),
            ("a window shows something", stage.window.stretch > 0.01 && stage.window.shift.abs() < 3.0),
            ("who holds it has a tool that does", stage.held_by.is_none() == holders.is_empty()),
            ("one visitor holds it", holders.iter().all(|&holder| Some(holder) == stage.held_by)),
            ("with two hands at most", holders.len() <= 2),
            ("tools are in order", is_sorted),
            ("tools that are shown are there", stage.tools.iter().all(|tool| tool.presence > 0.0)),
            ("nothing grows", self.history.len() <= MOST_DEEDS && self.waiting.len() <= MOST_WAITING),
            ("time goes on", stage.script_s >= 0.0 && stage.script_s.is_finite()),
        ];
        laws.into_iter().chain(self.menu_laws()).filter(|law| !law.1).map(|law| law.0).collect()
    }

    /// Those of menus.
    fn menu_laws(&self) -> [(&'static str, bool); 7] {
        let (stage, menus) = (self.stage(), &self.stage().menus);
        let is_shown = |menu: &Menu| stage.tools.iter().any(|tool| tool.tool == menu.tool);
        let trials: Vec<_> = menus.iter().filter_map(|menu| Some((menu.choice(), menu.trial?))).collect();
        let is_tried = |(choice, before): (Option<Choice>, Option<usize>)| match choice {
            Some(Choice::Band(band)) => stage.band == Some(band),
            Some(_) => false,
            None => stage.band == before,
        };
        [
            ("menus are of tools that are there", menus.iter().all(is_shown)),
            ("a tool has one menu at most", menus.windows(2).all(|pair| pair[0].tool < pair[1].tool)),
            ("a menu lists something", menus.iter().all(|menu| !menu.entries.is_empty())),
            ("what it lists can be chosen", menus.iter().all(|menu| self.has_all_of(menu))),
            (
                "what is marked is on it",
                menus.iter().all(|menu| menu.marked.is_none_or(|marked| marked < menu.entries.len())),
            ),
            ("one band is tried out at most", trials.len() <= 1),
            (
                "a band that is tried out is shown",
                trials.iter().all(|&(choice, trial)| is_tried((choice, trial.before))),
            ),
        ]
    }

    /// Whether there is all that a menu lists.
    fn has_all_of(&self, menu: &Menu) -> bool {
        let (item, tool) = (self.item(), &self.cast.tools[usize::from(menu.tool.0)]);
        menu.entries.iter().all(|entry| match entry.choice {
            Choice::Undo => true,
            Choice::Kind(kind) => tool.kinds.contains(&kind),
            Choice::Look(look) => look.is_none_or(|look| look < item.looks),
            Choice::Preset(preset) => preset < item.presets.len(),
            Choice::Item(item) => item < self.programme.0.len(),
            Choice::Band(band) => menu.trial.is_some() && band < item.bands,
        })
    }
}
