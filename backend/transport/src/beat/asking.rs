//! When back-ends are asked for their clocks.

use std::time::Duration;

/// How often.
const INTERVAL: Duration = Duration::from_millis(200);

/// The same while nothing happens: two clocks drift apart by some tens of microseconds in that time.
const INTERVAL_AT_REST: Duration = Duration::from_secs(5);

/// How long back-ends at rest are given to hear that a question follows.
const ROUSING: Duration = Duration::from_millis(15);

/// What to say now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Say {
    /// Nothing.
    Nothing,
    /// That somebody is there: a question follows.
    Alive,
    /// The question.
    Question,
}

/// When that was done.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asking {
    asked_at: Option<Duration>,
    roused_at: Option<Duration>,
}

impl Asking {
    /// What to say at a time; at rest, who is asked may hear the first word late.
    pub(super) fn say(&mut self, now: Duration, is_at_rest: bool) -> Say {
        let interval = if is_at_rest { INTERVAL_AT_REST } else { INTERVAL };
        if self.asked_at.is_some_and(|before| now < before + interval) {
            return Say::Nothing;
        }
        if is_at_rest {
            let Some(roused_at) = self.roused_at else {
                self.roused_at = Some(now);
                return Say::Alive;
            };
            if now < roused_at + ROUSING {
                return Say::Nothing;
            }
        }
        *self = Self { asked_at: Some(now), roused_at: None };
        Say::Question
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_rest_a_word_goes_before_each_question() {
        let (mut asking, at) = (Asking::default(), Duration::from_millis);
        assert_eq!(asking.say(at(0), false), Say::Question);
        assert_eq!(asking.say(at(100), false), Say::Nothing);
        assert_eq!(asking.say(at(200), false), Say::Question);
        assert_eq!(asking.say(at(1_200), true), Say::Nothing);
        assert_eq!(asking.say(at(5_200), true), Say::Alive);
        assert_eq!(asking.say(at(5_210), true), Say::Nothing);
        assert_eq!(asking.say(at(5_216), true), Say::Question);
        assert_eq!(asking.say(at(5_300), false), Say::Nothing);
    }
}
