//! The time that a display is driven by.

use super::showing::now_us;
use std::time::Duration;

/// A clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Time {
    /// This process's.
    Real,
    /// One that stands still while anything is under way, and then jumps to the next thing to do: for dumps and tests, in
    /// which a frame is never late.
    Stepped(Duration),
}

impl Time {
    /// One that begins at 0 and only steps.
    pub fn stepped() -> Self {
        Self::Stepped(Duration::ZERO)
    }

    /// What it says.
    pub fn now(&self) -> Duration {
        match self {
            Self::Real => Duration::from_micros(now_us()),
            Self::Stepped(now) => *now,
        }
    }

    pub(super) fn is_stepped(&self) -> bool {
        matches!(self, Self::Stepped(_))
    }

    /// Jumps ahead, if it is one that steps.
    pub(super) fn jump(&mut self, to: Duration) {
        if let Self::Stepped(now) = self {
            *now = to.max(*now);
        }
    }
}
