//! Where changes come from.

use super::Change;
use std::time::Duration;

/// The frame for which inputs are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// When it is made, on the display's clock.
    pub now: Duration,
    /// When it is to be seen.
    pub seen_at: Duration,
}

/// A source of changes: a window, a tracker, a tape.
pub trait Input {
    /// What has happened since it was last asked.
    fn poll(&mut self, moment: Moment, changes: &mut Vec<Change>);

    /// What has become of its devices since it was last asked, in sentences.
    fn news(&mut self) -> Vec<String> {
        Vec::new()
    }
}
