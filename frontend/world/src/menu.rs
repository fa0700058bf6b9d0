//! Lists from which visitors choose with a tool's tip: what lies where, and what is marked.

use crate::cast::{ToolId, ToolKind};
use glam::{DVec2, DVec3};
use serde::Serialize;
use std::time::Duration;

/// A mark stays until the tip is so far beyond its entry, metres: more than the 4 mm from end to end by which hands tremble.
const HYSTERESIS_M: f64 = 0.005;
/// Between the tip, where a menu opens, and its list, metres: nobody marks anything without a move.
const GAP_M: f64 = 0.012;

/// Something that visitors choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Choice {
    /// The visitor's latest deed is undone.
    Undo,
    /// The tool becomes this.
    Kind(ToolKind),
    /// A look, from 0 among the item's looks; None for its own.
    Look(Option<usize>),
    /// A placement, from 0 among the item's presets.
    Preset(usize),
    /// An item of the programme, from 0.
    Item(usize),
    /// A band of values, from 0 among the item's bands.
    Band(usize),
}

/// How large menus are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MenuSize {
    /// Width and height of an entry, metres, at least [`MenuSize::LEAST_M`].
    pub entry_m: DVec2,
    /// Entries above each other, at least 1.
    pub most_rows: usize,
    /// Columns of them beside each other, at least 1.
    pub most_columns: usize,
}

impl MenuSize {
    /// An entry is as high as this, metres: a tip that trembles in its middle third marks no other.
    pub const LEAST_M: f64 = 3.0 * HYSTERESIS_M;

    /// Column and row of each entry of groups of such sizes. A group for which a column has no room left begins the next, and
    /// one that is longer than a column goes on there.
    pub(crate) fn places(&self, groups: impl IntoIterator<Item = usize>) -> Vec<[usize; 2]> {
        let (mut places, mut column, mut row) = (Vec::new(), 0, 0);
        for group in groups {
            if row > 0 && row + group > self.most_rows {
                (column, row) = (column + 1, 0);
            }
            for _ in 0..group {
                if row == self.most_rows {
                    (column, row) = (column + 1, 0);
                }
                places.push([column, row]);
                row += 1;
            }
        }
        places
    }
}

/// An entry of a menu.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// What is chosen with it.
    pub choice: Choice,
    /// Its middle, metres from where the tip was, to the right and up.
    pub middle_m: DVec2,
}

/// A band is tried out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The band before.
    pub(crate) before: Option<usize>,
    /// Since when.
    pub(crate) since: Duration,
}

/// A list that is open while a button of a tool is down, beside where the tool's tip was and parallel to the screen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Menu {
    /// Whose.
    pub tool: ToolId,
    /// Where its tip was, metres, display frame.
    pub from_m: DVec3,
    /// Width and height of an entry, metres.
    pub entry_m: DVec2,
    /// What is on it, at least one thing; things of one kind follow each other.
    pub entries: Vec<Entry>,
    /// The entry over which the tip is.
    pub marked: Option<usize>,
    /// What is tried out, where the list is of bands.
    pub(crate) trial: Option<Trial>,
}

impl Menu {
    /// One that opens at the tip of a tool, on the side on which there is more of the screen. None where it lists nothing.
    pub(crate) fn new(tool: ToolId, from_m: DVec3, groups: &[Vec<Choice>], size: &MenuSize) -> Option<Self> {
        let places = size.places(groups.iter().map(Vec::len));
        let most = |axis: usize| places.iter().map(|place| place[axis] + 1).max();
        let (columns, rows) = (most(0)? as f64, most(1)? as f64);
        let left_m = if from_m.x > 0.0 { -GAP_M - columns * size.entry_m.x } else { GAP_M };
        let middle_m = |[column, row]: [usize; 2]| {
            let y = 0.5 * rows - 0.5 - row as f64;
            DVec2::new(left_m + (column as f64 + 0.5) * size.entry_m.x, y * size.entry_m.y)
        };
        let entry = |(&choice, place)| Entry { choice, middle_m: middle_m(place) };
        let entries = groups.iter().flatten().zip(places).map(entry).collect();
        Some(Self { tool, from_m, entry_m: size.entry_m, entries, marked: None, trial: None })
    }

    /// The corners of the list at the lower left and the upper right, metres from where the tip was.
    pub fn corners_m(&self) -> [DVec2; 2] {
        let (least, most) = self.entries.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |all, entry| {
            (all.0.min(entry.middle_m), all.1.max(entry.middle_m))
        });
        [least - 0.5 * self.entry_m, most + 0.5 * self.entry_m]
    }

    /// Marks what the tip is over. Whether that is another entry than before.
    pub(crate) fn mark(&mut self, tip_m: DVec3) -> bool {
        let at_m = (tip_m - self.from_m).truncate();
        let is_over = |entry: &Entry, margin_m: f64| {
            ((at_m - entry.middle_m).abs() - 0.5 * self.entry_m).max_element() <= margin_m
        };
        if self.marked.is_some_and(|marked| is_over(&self.entries[marked], HYSTERESIS_M)) {
            return false;
        }
        let marked = self.entries.iter().position(|entry| is_over(entry, 0.0));
        std::mem::replace(&mut self.marked, marked) != marked
    }

    /// What is chosen if the button is released now.
    pub(crate) fn choice(&self) -> Option<Choice> {
        self.entries.get(self.marked?).map(|entry| entry.choice)
    }
}

#[cfg(test)]
#[path = "menu_tests.rs"]
mod tests;
