//! What menus list.

use crate::cast::Tool;
use crate::menu::{Choice, MenuSize};
use crate::programme::Item;

/// All that the menu of a tool can ever list while an item of so many is shown, in groups.
pub fn choices(tool: &Tool, item: &Item, items: usize) -> [Vec<Choice>; 5] {
    let own_look = item.own_look.is_none().then_some(Choice::Look(None));
    [
        vec![Choice::Undo],
        tool.kinds.iter().map(|&kind| Choice::Kind(kind)).collect(),
        own_look.into_iter().chain((0..item.looks).map(|look| Choice::Look(Some(look)))).collect(),
        (0..item.presets.len()).map(Choice::Preset).collect(),
        (0..items).map(Choice::Item).collect(),
    ]
}

impl MenuSize {
    /// Whether there is always room for all that a tool's menus list while an item of so many is shown.
    pub fn has_room(&self, tool: &Tool, item: &Item, items: usize) -> bool {
        let deeds = choices(tool, item, items).map(|group| group.len());
        // Less on the list never takes more columns.
        [self.places(deeds), self.places([item.bands])]
            .iter()
            .flatten()
            .all(|&[column, _]| column < self.most_columns)
    }
}
