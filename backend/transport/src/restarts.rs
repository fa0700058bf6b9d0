//! How long to wait before a renderer is started again.

use std::time::{Duration, Instant};

/// One that drew for so long ended for a reason that may not be there again. A fault that lies in the frame at hand, or in
/// opening the device, ends one in a moment.
const FULL_LIFE: Duration = Duration::from_secs(3);

/// So many are started at once, one after another, however short they live.
pub const AT_ONCE: u32 = 4;

const FIRST_WAIT: Duration = Duration::from_secs(1);
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// How the renderers of one back-end fared of late.
#[derive(Debug, Default)]
pub struct Restarts {
    /// Those that ended soon, one after another.
    in_a_row: u32,
    /// When the present one was ready to draw.
    ready_at: Option<Instant>,
}

impl Restarts {
    /// The present one is ready to draw.
    pub fn ready(&mut self, now: Instant) {
        self.ready_at = Some(now);
    }

    /// The present one has ended: how long to wait.
    pub fn ended(&mut self, now: Instant) -> Duration {
        let lived = self.ready_at.take().map_or(Duration::ZERO, |at| now.saturating_duration_since(at));
        self.in_a_row = if lived < FULL_LIFE { self.in_a_row.saturating_add(1) } else { 1 };
        match self.in_a_row.checked_sub(AT_ONCE + 1) {
            None => Duration::ZERO,
            Some(waits) => FIRST_WAIT.saturating_mul(1 << waits.min(16)).min(LONGEST_WAIT),
        }
    }

    /// What to say of the wait, once for many that end soon.
    #[cfg(any(feature = "mpi", test))]
    pub fn note(&self) -> Option<String> {
        let (count, most) = (self.in_a_row, LONGEST_WAIT.as_secs());
        (count == AT_ONCE + 1).then(|| {
            format!("; {count} have ended soon after their start, so the next ones wait longer and longer, up to {most} s")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_end_soon_wait_longer_and_one_that_lives_ends_that() {
        let (mut restarts, mut now) = (Restarts::default(), Instant::now());
        let mut waits = |lived: Option<u64>, times: usize| -> Vec<(u64, bool)> {
            let one = |_| {
                if let Some(seconds) = lived {
                    restarts.ready(now);
                    now += Duration::from_secs(seconds);
                }
                (restarts.ended(now).as_secs(), restarts.note().is_some())
            };
            (0..times).map(one).collect()
        };
        let quiet = |seconds: u64| (seconds, false);
        let expected = [0, 0, 0, 0].map(quiet).into_iter().chain([(1, true)]);
        let expected: Vec<_> = expected.chain([2, 4, 8, 16, 32, 60, 60].map(quiet)).collect();
        assert_eq!(waits(None, 12), expected, "that cannot be opened");
        assert_eq!(waits(Some(10), 9), vec![quiet(0); 9]);
        assert_eq!(waits(Some(1), 5)[..4], [0, 0, 0, 1].map(|seconds| (seconds, seconds > 0)));
    }
}
