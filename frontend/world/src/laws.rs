//! What a world is, whatever visitors do.

use crate::cast::VisitorId;
use crate::history::MOST_DEEDS;
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
        laws.into_iter().filter(|law| !law.1).map(|law| law.0).collect()
    }
}
