//! How much of a picture fits into a tick.

use std::time::Duration;

/// The weight of the latest tick in what a unit takes of late.
const LATEST: f64 = 0.3;

/// How many units of a picture a tick casts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// As many as fit into a time.
    Time {
        /// The time.
        tick: Duration,
        /// What one takes of late, seconds; None while nobody knows.
        unit_s: Option<f64>,
    },
    /// Always the same number: for tests and dumps, whose pictures must not depend on a machine's speed.
    Fixed(u32),
}

impl Budget {
    /// As many as fit into a time.
    pub fn of_time(tick: Duration) -> Self {
        Self::Time { tick, unit_s: None }
    }

    /// Units of the next tick; at least one.
    pub fn units(&self) -> u32 {
        match *self {
            Self::Fixed(units) => units.max(1),
            Self::Time { unit_s: None, .. } => 1,
            Self::Time { tick, unit_s: Some(unit_s) } => {
                (tick.as_secs_f64() / unit_s.max(1e-9)).clamp(1.0, 1e6) as u32
            }
        }
    }

    /// A tick of so many units took the slowest back-end so long.
    pub fn took(&mut self, units: u32, time: Duration) {
        let Self::Time { unit_s, .. } = self else { return };
        let now = time.as_secs_f64() / f64::from(units.max(1));
        let before = unit_s.unwrap_or(now);
        *unit_s = Some(before + LATEST * (now - before));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_filled_and_not_overfilled() {
        let mut budget = Budget::of_time(Duration::from_millis(16));
        assert_eq!(budget.units(), 1);
        budget.took(1, Duration::from_millis(2));
        assert_eq!(budget.units(), 8);
        for _ in 0..40 {
            budget.took(8, Duration::from_millis(160));
        }
        assert_eq!(budget.units(), 1, "a slow machine casts one at a time");
        assert_eq!(Budget::Fixed(0).units(), 1);
        assert_eq!(Budget::Fixed(16).units(), 16);
    }
}
