//! When to ask again for a brick that could not be had.

use crate::store::{BrickErrorKind, NodeKey};
use std::collections::HashMap;
use std::time::Duration;

/// The wait after the first failure; each further one doubles it.
const FIRST_WAIT: Duration = Duration::from_secs(1);
/// The longest wait.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// What failed, and from when on it may be asked for again: what could not be read 1 s after the first failure, 2 s
/// after the second, then 4, 8, …, 60 s; what is damaged never. Pure: times are those since any start.
#[derive(Clone, Debug, Default)]
pub struct Retry {
    failed: HashMap<NodeKey, Failure>,
}

#[derive(Clone, Copy, Debug)]
struct Failure {
    /// None: it is damaged.
    again_at: Option<Duration>,
    wait: Duration,
}

impl Retry {
    /// Nothing has failed.
    pub fn new() -> Self {
        Self::default()
    }

    /// Notes a failed read; tells whether it is the brick's first, which is the one to say in the log.
    pub fn failed(&mut self, key: NodeKey, kind: BrickErrorKind, now: Duration) -> bool {
        let before = self.failed.get(&key);
        let wait = before.map_or(FIRST_WAIT, |failure| (2 * failure.wait).min(LONGEST_WAIT));
        let again_at = match kind {
            BrickErrorKind::Damaged => None,
            BrickErrorKind::Unavailable => Some(now + wait),
        };
        self.failed.insert(key, Failure { again_at, wait }).is_none()
    }

    /// Notes that a brick came: a later failure is its first.
    pub fn came(&mut self, key: NodeKey) {
        self.failed.remove(&key);
    }

    /// Whether a brick may be asked for: it never failed, or its wait is over.
    pub fn may_ask(&self, key: NodeKey, now: Duration) -> bool {
        self.failed.get(&key).is_none_or(|failure| failure.again_at.is_some_and(|at| at <= now))
    }

    /// When a brick may be asked for again: None where never; zero where it did not fail.
    pub fn again_at(&self, key: NodeKey) -> Option<Duration> {
        self.failed.get(&key).map_or(Some(Duration::ZERO), |failure| failure.again_at)
    }

    /// When the first of the waits after `now` is over; None where nothing will change by waiting.
    pub fn next(&self, now: Duration) -> Option<Duration> {
        self.failed.values().filter_map(|failure| failure.again_at).filter(|&at| at > now).min()
    }

    /// Bricks that failed last time.
    pub fn count(&self) -> usize {
        self.failed.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: NodeKey = NodeKey::ROOT;

    fn seconds(count: u64) -> Duration {
        Duration::from_secs(count)
    }

    #[test]
    fn waits_double_up_to_a_minute() {
        let (mut retry, mut now) = (Retry::new(), seconds(100));
        for (count, wait) in [1, 2, 4, 8, 16, 32, 60, 60].map(seconds).into_iter().enumerate() {
            assert!(retry.may_ask(KEY, now));
            assert_eq!(retry.failed(KEY, BrickErrorKind::Unavailable, now), count == 0);
            assert!(!retry.may_ask(KEY, now + wait - Duration::from_nanos(1)));
            assert_eq!(retry.next(now), Some(now + wait));
            now += wait;
        }
        assert_eq!((retry.next(now), retry.count()), (None, 1));
        retry.came(KEY);
        assert!(retry.may_ask(KEY, seconds(0)) && retry.count() == 0);
        assert!(retry.failed(KEY, BrickErrorKind::Unavailable, now));
        assert!(retry.may_ask(KEY, now + seconds(1)));
    }

    #[test]
    fn what_is_damaged_is_not_asked_for_again() {
        let mut retry = Retry::new();
        retry.failed(KEY, BrickErrorKind::Unavailable, seconds(0));
        retry.failed(KEY, BrickErrorKind::Damaged, seconds(1));
        assert!(!retry.may_ask(KEY, seconds(1 << 40)));
        assert_eq!(retry.next(seconds(0)), None);
        assert!(retry.may_ask(KEY.child(3), seconds(0)));
    }
}
