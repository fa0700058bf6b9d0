//! How long back-ends may keep the front-end waiting.

use std::time::Duration;

/// How long a back-end may keep the front-end waiting before it counts as lost. Only time in which the front-end listens
/// counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Without any message: one that works says that it lives, however long a piece of the work takes.
    pub silence: Duration,
    /// Without any news of its work, though it lives. A piece of the work ends in time: a batch of tiles, some bricks, the
    /// compilation of a kernel.
    pub standstill: Duration,
}

impl Default for Limits {
    /// A minute, and ten. A process that dies is noticed in a second whatever these say; they are for one that lives and
    /// is stuck, and for other hosts.
    fn default() -> Self {
        Self { silence: Duration::from_secs(60), standstill: Duration::from_secs(600) }
    }
}

/// How long one back-end has kept the front-end waiting.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patience {
    /// Since its last message.
    pub silence: Duration,
    /// Since its last message that was more than a sign of life.
    pub standstill: Duration,
}

impl Patience {
    /// Nothing came from it for a while.
    pub fn waited(&mut self, listened: Duration) {
        self.silence += listened;
        self.standstill += listened;
    }

    /// Something came from it; `is_news` where that was more than a sign of life.
    pub fn heard(&mut self, is_news: bool) {
        let standstill = if is_news { Duration::ZERO } else { self.standstill };
        *self = Self { silence: Duration::ZERO, standstill };
    }
}
