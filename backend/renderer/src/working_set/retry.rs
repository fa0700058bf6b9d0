//! When to ask again for a brick that could not be read.

use bricks::{BrickErrorKind, NodeKey};
use std::collections::HashMap;

/// The wait after the first failure, seconds; each further one doubles it.
const FIRST_WAIT_S: f64 = 1.0;
/// The longest wait.
const LONGEST_WAIT_S: f64 = 60.0;

/// What failed, and from when on it may be asked for again: what could not be read 1 s after the first failure, 2 s
/// after the second, then 4, 8, …, 60 s; what is damaged never. Pure: times are seconds on any clock that does not run
/// back.
#[derive(Clone, Debug, Default)]
pub struct Retry {
    failed: HashMap<NodeKey, Failure>,
    /// Of the parents of these: when all of their children may be asked for.
    families: HashMap<NodeKey, f64>,
}

#[derive(Clone, Copy, Debug)]
struct Failure {
    /// ∞ for what is damaged.
    again_s: f64,
    wait_s: f64,
    /// Whether it shows anything now: its family can do without what shows nothing.
    is_shown: bool,
}

impl Retry {
    /// Nothing has failed.
    pub fn new() -> Self {
        Self::default()
    }

    /// Notes a failed read; returns whether it is the brick's first, which is the one to log.
    pub fn failed(&mut self, key: NodeKey, kind: BrickErrorKind, now_s: f64) -> bool {
        self.forget_old(now_s);
        let before = self.failed.get(&key);
        let wait_s = before.map_or(FIRST_WAIT_S, |failure| (2.0 * failure.wait_s).min(LONGEST_WAIT_S));
        let again_s = match kind {
            BrickErrorKind::Damaged => f64::INFINITY,
            BrickErrorKind::Unavailable => now_s + wait_s,
        };
        let is_first = self.failed.insert(key, Failure { again_s, wait_s, is_shown: true }).is_none();
        self.tell_family(key);
        is_first
    }

    /// Notes that a brick came: a later failure is its first.
    pub fn came(&mut self, key: NodeKey) {
        if self.failed.remove(&key).is_some() {
            self.tell_family(key);
        }
    }

    /// The transfer functions have changed: notes which of what failed shows anything.
    pub fn look_anew(&mut self, shows: impl Fn(NodeKey) -> bool) {
        self.families.clear();
        let keys: Vec<NodeKey> = self.failed.keys().copied().collect();
        for (&key, failure) in &mut self.failed {
            failure.is_shown = shows(key);
        }
        keys.into_iter().for_each(|key| self.tell_family(key));
    }

    /// Whether a brick may be asked for: it never failed, or its wait is over.
    pub fn may_ask(&self, key: NodeKey, now_s: f64) -> bool {
        self.failed.get(&key).is_none_or(|failure| failure.again_s <= now_s)
    }

    /// Whether all children of a node may be asked for.
    pub fn may_ask_below(&self, key: NodeKey, now_s: f64) -> bool {
        // Mostly nothing has failed.
        self.families.is_empty() || self.families.get(&key).is_none_or(|&again_s| again_s <= now_s)
    }

    /// When the first of the waits after `now_s` is over; None if nothing will change by waiting.
    pub fn next(&self, now_s: f64) -> Option<f64> {
        let waits = self.failed.values().map(|failure| failure.again_s);
        waits.filter(|&at| at > now_s && at.is_finite()).min_by(f64::total_cmp)
    }

    /// Bricks that failed last time.
    pub fn count(&self) -> usize {
        self.failed.len()
    }

    fn tell_family(&mut self, key: NodeKey) {
        let Some(parent) = key.parent() else { return };
        let of = |octant| {
            let failure = self.failed.get(&parent.child(octant)).filter(|failure| failure.is_shown);
            failure.map(|failure| failure.again_s)
        };
        match (0..8).filter_map(of).max_by(f64::total_cmp) {
            Some(again_s) => self.families.insert(parent, again_s),
            None => self.families.remove(&parent),
        };
    }

    /// A brick not asked for since long after its wait was over counts as new.
    fn forget_old(&mut self, now_s: f64) {
        self.failed.retain(|_, failure| failure.again_s + 2.0 * LONGEST_WAIT_S >= now_s);
        self.families.retain(|_, again_s| *again_s + 2.0 * LONGEST_WAIT_S >= now_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: NodeKey = NodeKey::ROOT;

    #[test]
    fn waits_double_up_to_a_minute() {
        let (mut retry, mut now_s) = (Retry::new(), 100.0);
        for (count, wait_s) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0].into_iter().enumerate() {
            assert!(retry.may_ask(KEY, now_s));
            assert_eq!(retry.failed(KEY, BrickErrorKind::Unavailable, now_s), count == 0);
            assert!(!retry.may_ask(KEY, now_s + wait_s - 1e-9));
            assert_eq!(retry.next(now_s), Some(now_s + wait_s));
            now_s += wait_s;
        }
        assert_eq!((retry.next(now_s), retry.count()), (None, 1));
        retry.came(KEY);
        assert!(retry.may_ask(KEY, 0.0) && retry.count() == 0);
        assert!(retry.failed(KEY, BrickErrorKind::Unavailable, now_s));
        assert!(retry.may_ask(KEY, now_s + 1.0));
    }

    #[test]
    fn what_is_damaged_is_not_asked_for_again() {
        let mut retry = Retry::new();
        retry.failed(KEY, BrickErrorKind::Unavailable, 0.0);
        retry.failed(KEY, BrickErrorKind::Damaged, 1.0);
        assert!(!retry.may_ask(KEY, 1e12));
        assert_eq!(retry.next(0.0), None);
        assert!(retry.may_ask(KEY.child(3), 0.0));
    }

    #[test]
    fn a_family_waits_for_the_last_of_its_bricks() {
        let mut retry = Retry::new();
        retry.failed(KEY.child(1), BrickErrorKind::Damaged, 0.0);
        retry.failed(KEY.child(2), BrickErrorKind::Unavailable, 0.0);
        assert!(!retry.may_ask_below(KEY, 5.0) && retry.may_ask_below(KEY.child(1), 0.0));
        retry.came(KEY.child(1));
        assert!(!retry.may_ask_below(KEY, 0.5) && retry.may_ask_below(KEY, 1.0));
        retry.came(KEY.child(2));
        assert!(retry.may_ask_below(KEY, 0.0));
    }

    #[test]
    fn old_failures_are_forgotten_and_damage_is_not() {
        let mut retry = Retry::new();
        retry.failed(KEY.child(1), BrickErrorKind::Unavailable, 0.0);
        retry.failed(KEY.child(2), BrickErrorKind::Damaged, 0.0);
        retry.failed(KEY.child(3), BrickErrorKind::Unavailable, 1000.0);
        assert_eq!(retry.count(), 2);
        assert!(!retry.may_ask_below(KEY, 2000.0));
    }
}
