//! Where changes come from.

use super::Change;
use std::time::Duration;

/// A source of changes: a window, a tracker, a tape.
pub trait Input {
    /// What has happened since it was last asked. `now` is the display's clock.
    fn poll(&mut self, now: Duration, changes: &mut Vec<Change>);
}
