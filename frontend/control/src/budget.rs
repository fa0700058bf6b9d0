//! How much of a picture fits into a tick.

use std::time::Duration;

/// The weight of the latest tick in what things take of late.
const LATEST: f64 = 0.3;

/// How many units of a picture a tick casts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// As many as fit into a time; but casting never takes less than the rest of a tick does, which would be waste.
    Time {
        /// The time.
        tick: Duration,
        /// What one takes of late, and the rest of a tick, seconds; None while nobody knows.
        takes_s: Option<[f64; 2]>,
    },
    /// Always the same number: for tests and dumps, whose pictures must not depend on a machine's speed.
    Fixed(u32),
}

impl Budget {
    /// As many as fit into a time.
    pub fn of_time(tick: Duration) -> Self {
        Self::Time { tick, takes_s: None }
    }

    /// Units of the next tick; at least one.
    pub fn units(&self) -> u32 {
        match *self {
            Self::Fixed(units) => units.max(1),
            Self::Time { takes_s: None, .. } => 1,
            Self::Time { tick, takes_s: Some([unit_s, rest_s]) } => {
                let casting_s = (tick.as_secs_f64() - rest_s).max(rest_s);
                (casting_s / unit_s.max(1e-9)).clamp(1.0, 1e6) as u32
            }
        }
    }

    /// A tick of so many units took the slowest back-end so long, of which it cast rays for so long.
    pub fn took(&mut self, units: u32, total: Duration, casting: Duration) {
        let Self::Time { takes_s, .. } = self else { return };
        let rest_s = total.saturating_sub(casting).as_secs_f64();
        let now = [casting.as_secs_f64() / f64::from(units.max(1)), rest_s];
        let before = takes_s.unwrap_or(now);
        *takes_s = Some(std::array::from_fn(|i| before[i] + LATEST * (now[i] - before[i])));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn a_tick_is_filled_and_not_overfilled() {
        let mut budget = Budget::of_time(16 * MS);
        assert_eq!(budget.units(), 1);
        budget.took(1, 2 * MS, 2 * MS);
        assert_eq!(budget.units(), 8);
        for _ in 0..40 {
            budget.took(8, 160 * MS, 160 * MS);
        }
        assert_eq!(budget.units(), 1, "a slow machine casts one at a time");
        assert_eq!(Budget::Fixed(0).units(), 1);
        assert_eq!(Budget::Fixed(16).units(), 16);
    }

    #[test]
    fn what_a_tick_takes_besides_is_left_for_it_and_outweighs_nothing() {
        let mut budget = Budget::of_time(16 * MS);
        budget.took(4, 8 * MS, 4 * MS);
        assert_eq!(budget.units(), 12, "4 ms are for the rest");
        let mut slow = Budget::of_time(16 * MS);
        slow.took(1, 100 * MS, 5 * MS);
        assert_eq!(slow.units(), 19, "a rest of 95 ms is worth as long a cast");
    }
}
