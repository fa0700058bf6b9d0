//! When a link may look for messages now and then only.
//!
//! A display that shows something still has nothing to say for hours, and a look for messages takes some 40 µs of a core. So
//! whoever has had no work for a second looks every ten milliseconds. The first message after that may be heard so much
//! later; it ends the rest, so no other is. Clocks are not compared across a doze: who asks says something first.

use protocol::{FromBackend, FromFrontend};
use std::time::{Duration, Instant};

/// So long after its last work a link is at rest.
const RESTS_AFTER: Duration = Duration::from_secs(1);

/// So long after any message it is awake: longer than the front-end lets pass between two looks at what is due.
const STAYS_AWAKE: Duration = Duration::from_millis(80);

/// From one look for messages to the next, at rest.
pub(crate) const DOZE: Duration = Duration::from_millis(10);

/// What a message is to a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Matter {
    /// Something is to be done, or has been.
    Work,
    /// A question after the clock, or a sign of life.
    Upkeep,
}

impl From<&FromFrontend> for Matter {
    fn from(message: &FromFrontend) -> Self {
        match message {
            FromFrontend::Alive | FromFrontend::Clock { .. } => Self::Upkeep,
            _ => Self::Work,
        }
    }
}

impl From<&FromBackend> for Matter {
    fn from(message: &FromBackend) -> Self {
        match message {
            FromBackend::Alive | FromBackend::Clock { .. } => Self::Upkeep,
            _ => Self::Work,
        }
    }
}

/// What a link knows of its latest messages, sent and received.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rest {
    worked_at: Instant,
    spoke_at: Instant,
}

impl Rest {
    /// Of a link that begins now.
    pub(crate) fn new(now: Instant) -> Self {
        Self { worked_at: now, spoke_at: now }
    }

    /// A message has come or gone.
    pub(crate) fn note(&mut self, matter: impl Into<Matter>, now: Instant) {
        let matter = matter.into();
        self.spoke_at = now;
        if matter == Matter::Work {
            self.worked_at = now;
        }
    }

    /// Whether nothing but upkeep has been said for long.
    pub(crate) fn is_at_rest(&self, now: Instant) -> bool {
        now.saturating_duration_since(self.worked_at) > RESTS_AFTER
    }

    /// Whether to look for messages now and then only.
    pub(crate) fn is_dozing(&self, now: Instant) -> bool {
        self.is_at_rest(now) && now.saturating_duration_since(self.spoke_at) > STAYS_AWAKE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upkeep_wakes_for_a_moment_and_work_ends_the_rest() {
        let start = Instant::now();
        let at = |ms| start + Duration::from_millis(ms);
        let mut rest = Rest::new(start);
        assert!(!rest.is_at_rest(at(900)));
        assert!(rest.is_at_rest(at(1_100)) && rest.is_dozing(at(1_100)));
        rest.note(Matter::Upkeep, at(1_200));
        assert!(rest.is_at_rest(at(1_210)) && !rest.is_dozing(at(1_210)));
        assert!(rest.is_dozing(at(1_300)));
        rest.note(Matter::Work, at(1_400));
        assert!(!rest.is_at_rest(at(2_300)) && !rest.is_dozing(at(2_300)));
        assert!(rest.is_dozing(at(2_500)));
    }
}
