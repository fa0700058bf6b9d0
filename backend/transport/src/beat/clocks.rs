//! How far another process's clock is ahead of this one's, from questions and answers (Cristian's method).

use std::collections::VecDeque;

/// Answers that are remembered: clocks drift by some microseconds a second, so old ones say less and less.
const REMEMBERED: usize = 16;

/// One answer. Times in microseconds.
#[derive(Clone, Copy, Debug)]
struct Answer {
    /// The other clock, less the middle of asking and hearing on this one.
    ahead_us: i64,
    /// From asking to hearing: twice the most that `ahead_us` can err by.
    trip_us: u64,
}

/// What is known of one other clock.
#[derive(Clone, Debug, Default)]
pub struct OtherClock {
    answers: VecDeque<Answer>,
}

impl OtherClock {
    /// It was asked at `asked_us` and heard at `heard_us` on this clock, and said `there_us`.
    pub fn learn(&mut self, asked_us: u64, there_us: u64, heard_us: u64) {
        let middle = asked_us as i64 + (heard_us.saturating_sub(asked_us) / 2) as i64;
        let answer =
            Answer { ahead_us: there_us as i64 - middle, trip_us: heard_us.saturating_sub(asked_us) };
        if self.answers.len() == REMEMBERED {
            self.answers.pop_front();
        }
        self.answers.push_back(answer);
    }

    /// The answer that took the shortest way, and so errs least.
    fn best(&self) -> Option<Answer> {
        self.answers.iter().copied().min_by_key(|answer| answer.trip_us)
    }

    /// A time of this clock on the other; the same before anything is known.
    pub fn there(&self, here_us: u64) -> u64 {
        here_us.saturating_add_signed(self.best().map_or(0, |answer| answer.ahead_us))
    }

    /// A time of the other clock on this one.
    pub fn here(&self, there_us: u64) -> u64 {
        there_us.saturating_add_signed(-self.best().map_or(0, |answer| answer.ahead_us))
    }

    /// The usual way there and back of late, microseconds; None before anything is known.
    pub fn usual_trip_us(&self) -> Option<u64> {
        let mut trips: Vec<u64> = self.answers.iter().map(|answer| answer.trip_us).collect();
        trips.sort_unstable();
        trips.get(trips.len() / 2).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn errs_by_no_more_than_half_the_shortest_trip(
            ahead in -1_000_000_i64..1_000_000, trips in prop::collection::vec((0_u64..5000, 0_u64..5000), 1..40),
        ) {
            let mut clock = OtherClock::default();
            let mut now = 2_000_000;
            for &(there, back) in &trips {
                clock.learn(now, (now + there).saturating_add_signed(ahead), now + there + back);
                now += 20_000;
            }
            let shortest = trips.iter().rev().take(REMEMBERED).map(|(there, back)| there + back).min().unwrap();
            let err = clock.there(now) as i64 - (now as i64 + ahead);
            prop_assert!(err.unsigned_abs() <= shortest / 2 + 1, "{err} {shortest}");
            prop_assert_eq!(clock.here(clock.there(now)), now);
        }
    }
}
