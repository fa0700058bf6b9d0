//! How much of a tool is there while its target comes and goes.

use std::time::Duration;

/// A tool whose target is lost stays for so long.
const HOLD: Duration = Duration::from_millis(500);
/// It fades in and out in so long.
const FADE: Duration = Duration::from_millis(300);

/// When a target was last seen, and how much of its tool was there then, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Presence {
    pub seen: Duration,
    pub amount: f64,
}

impl Presence {
    /// How much is there at another time if the target is not seen again: it goes on coming, stays while it is held, and goes.
    /// A time long before the target was seen belongs to another clock, and is as bad as one long after it.
    pub fn at(&self, now: Duration) -> f64 {
        let passed = now.abs_diff(self.seen);
        let held = passed.min(HOLD);
        let fades = |time: Duration| time.as_secs_f64() / FADE.as_secs_f64();
        ((self.amount + fades(held)).min(1.0) - fades(passed - held)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tool_comes_stays_and_goes() {
        let seen = Duration::from_secs(10);
        let at = |amount: f64, ms: u64| Presence { seen, amount }.at(seen + Duration::from_millis(ms));
        assert_eq!([at(0.0, 0), at(0.0, 150), at(0.0, 300), at(0.0, 500)], [0.0, 0.5, 1.0, 1.0]);
        assert_eq!([at(1.0, 0), at(1.0, 500), at(1.0, 650), at(1.0, 800)], [1.0, 1.0, 0.5, 0.0]);
        assert_eq!(at(1.0, u64::MAX / 2), 0.0);
        let early = |ms: u64| Presence { seen, amount: 1.0 }.at(seen - Duration::from_millis(ms));
        assert_eq!([early(30), early(500), early(900)], [1.0, 1.0, 0.0]);
    }
}
