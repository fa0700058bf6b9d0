//! The pause between two checks for a message.

use std::time::Duration;

const YIELDS: u32 = 100;
const SHORTEST: Duration = Duration::from_micros(20);
const LONGEST: Duration = Duration::from_millis(1);

/// Waits that grow from nothing to a millisecond: a quick answer is seen at once, and a long wait leaves the cores to
/// the back-ends that draw.
#[derive(Default)]
pub struct Pause {
    yields: u32,
    next: Duration,
}

impl Pause {
    /// Waits; `is_moving` keeps the wait short, because a transfer advances only while both ends poll it.
    pub fn wait(&mut self, is_moving: bool) {
        match self.length(is_moving) {
            Duration::ZERO => std::thread::yield_now(),
            length => std::thread::sleep(length),
        }
    }

    /// How long to wait this time, for who has something else to wait for; zero is to let others run.
    pub fn length(&mut self, is_moving: bool) -> Duration {
        if self.yields < YIELDS {
            self.yields += 1;
            return Duration::ZERO;
        }
        let longest = if is_moving { SHORTEST } else { LONGEST };
        self.next = (self.next * 2).clamp(SHORTEST, longest);
        self.next
    }
}
