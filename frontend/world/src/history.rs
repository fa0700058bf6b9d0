//! What visitors did, to be undone.

use crate::cast::{ToolId, VisitorId};
use crate::stage::{Handling, Window};
use std::collections::VecDeque;

/// Deeds that are remembered.
pub const MOST_DEEDS: usize = 64;

/// What was before a deed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Before {
    /// How the volume was handled.
    Handling(Handling),
    /// Its look, and the window of values.
    Look(Option<usize>, Window),
    /// The window of values.
    Window(Window),
    /// The band.
    Band(Option<usize>),
    /// Which of its kinds a tool was.
    Kind(ToolId, usize),
}

/// Things that a deed changes: what another has changed since cannot be undone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Thing {
    Handling,
    Look,
    Band,
    Kind(ToolId),
}

impl Before {
    fn thing(&self) -> Thing {
        match self {
            Self::Handling(_) => Thing::Handling,
            // Another look has a window of its own.
            Self::Look(..) | Self::Window(_) => Thing::Look,
            Self::Band(_) => Thing::Band,
            Self::Kind(tool, _) => Thing::Kind(*tool),
        }
    }
}

/// Why a deed cannot be undone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoUndo {
    /// There is none of this visitor's.
    Nothing,
    /// Another has changed the same thing since.
    ChangedBy(VisitorId),
}

/// The latest deeds.
#[derive(Clone, Debug, Default)]
pub struct History(VecDeque<(VisitorId, Before)>);

impl History {
    /// A visitor does something; this was before.
    pub fn push(&mut self, visitor: VisitorId, before: Before) {
        if self.0.len() == MOST_DEEDS {
            self.0.pop_front();
        }
        self.0.push_back((visitor, before));
    }

    /// What was before a visitor's latest deed, which is forgotten.
    ///
    /// # Errors
    /// There is none, or another has changed the same thing since.
    pub fn undo(&mut self, visitor: VisitorId) -> Result<Before, NoUndo> {
        let place = self.0.iter().rposition(|deed| deed.0 == visitor).ok_or(NoUndo::Nothing)?;
        let before = self.0[place].1;
        let later = self.0.range(place + 1..).rfind(|deed| deed.1.thing() == before.thing());
        if let Some(&(changed_by, _)) = later {
            return Err(NoUndo::ChangedBy(changed_by));
        }
        self.0.remove(place);
        Ok(before)
    }

    /// Whether there is a deed of a visitor's.
    pub fn has_deed_of(&self, visitor: VisitorId) -> bool {
        self.0.iter().any(|deed| deed.0 == visitor)
    }

    /// How many deeds are remembered.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Nothing can be undone any more.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANN: VisitorId = VisitorId(0);
    const BEN: VisitorId = VisitorId(1);

    #[test]
    fn a_visitor_undoes_what_is_theirs_and_no_other_has_changed_since() {
        let mut history = History::default();
        assert_eq!(history.undo(ANN), Err(NoUndo::Nothing));
        history.push(ANN, Before::Look(None, Window::default()));
        history.push(ANN, Before::Band(Some(1)));
        history.push(BEN, Before::Window(Window { shift: 0.5, stretch: 1.0 }));
        assert_eq!(history.undo(ANN), Ok(Before::Band(Some(1))));
        assert_eq!(history.undo(ANN), Err(NoUndo::ChangedBy(BEN)), "a window belongs to its look");
        assert!(history.undo(BEN).is_ok());
        assert_eq!(history.undo(ANN), Ok(Before::Look(None, Window::default())));
        assert_eq!(history.undo(ANN), Err(NoUndo::Nothing));
    }

    #[test]
    fn it_does_not_grow() {
        let mut history = History::default();
        (0..1000).for_each(|i| history.push(ANN, Before::Band(Some(i))));
        let undone = std::iter::from_fn(|| history.undo(ANN).ok());
        assert_eq!(undone.count(), MOST_DEEDS);
    }
}
