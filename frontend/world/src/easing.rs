//! A volume on its way to a place.

use crate::stage::Handling;
use crate::turn::between;
use std::time::Duration;

/// From one handling to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Easing {
    from: Handling,
    to: Handling,
    began: Duration,
    length: Duration,
}

impl Easing {
    /// From a time on, within another.
    pub fn new(from: Handling, to: Handling, began: Duration, length: Duration) -> Self {
        Self { from, to, began, length }
    }

    /// Where it leads.
    pub fn aim(&self) -> Handling {
        self.to
    }

    /// The handling at a time, and whether it has arrived.
    pub fn at(&self, now: Duration) -> (Handling, bool) {
        let t = now.saturating_sub(self.began).as_secs_f64() / self.length.as_secs_f64();
        if t >= 1.0 {
            return (self.to, true);
        }
        let share = t * t * (3.0 - 2.0 * t);
        let handling = Handling {
            turn: between(self.from.turn, self.to.turn, share),
            shift_m: self.from.shift_m.lerp(self.to.shift_m, share),
            scale: self.from.scale + share * (self.to.scale - self.from.scale),
        };
        (handling, false)
    }
}
