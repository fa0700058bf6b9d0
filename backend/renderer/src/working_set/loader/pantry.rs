//! The pantry: the bricks that were read and not yet taken, as many as memory allows.

use super::load::{LoadedBrick, SAMPLE_BYTES};
use bricks::NodeKey;
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

/// What a brick is worth: of two, the lesser is given up first. No two bricks are worth the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Worth {
    /// It is not asked for now. The number rises with time: what was left long ago goes first.
    Left(u64),
    /// It may be asked for soon; its place in the list.
    Prefetched(Reverse<u32>),
    /// It is asked for; its place in the list.
    Wanted(Reverse<u32>),
}

impl Worth {
    /// The least of what is listed, asked for now or soon.
    const LEAST_LISTED: Self = Worth::Prefetched(Reverse(u32::MAX));
    const LEAST_WANTED: Self = Worth::Wanted(Reverse(u32::MAX));

    pub fn is_wanted(self) -> bool {
        self >= Self::LEAST_WANTED
    }
}

/// What each listed key is worth.
pub(super) type Listed = HashMap<NodeKey, Worth>;

/// Bricks by worth, bounded in bytes.
#[derive(Debug)]
pub(super) struct Pantry {
    capacity: usize,
    kept: HashMap<NodeKey, (Worth, LoadedBrick)>,
    order: BTreeMap<Worth, NodeKey>,
    /// The next number of what is left.
    clock: u64,
}

impl Pantry {
    /// Room for so many bytes of samples, and for `least` bricks in any case: their cells take a thirtieth more, standard deviations
    /// half as much again where the volume keeps them.
    pub fn new(bytes: u64, least: usize) -> Self {
        let capacity = usize::try_from(bytes / SAMPLE_BYTES).unwrap_or(usize::MAX).max(least);
        Self { capacity, kept: HashMap::new(), order: BTreeMap::new(), clock: 0 }
    }

    pub fn holds(&self, key: NodeKey) -> bool {
        self.kept.contains_key(&key)
    }

    pub fn bytes(&self) -> u64 {
        self.kept.len() as u64 * SAMPLE_BYTES
    }

    /// Whether a brick of this worth would stay after `coming` others were put in.
    pub fn has_room(&self, worth: Worth, coming: usize) -> bool {
        let leaving = (self.kept.len() + coming + 1).saturating_sub(self.capacity);
        leaving == 0 || self.order.keys().nth(leaving - 1).is_some_and(|&last| last < worth)
    }

    /// Puts a brick in. Without room, gives up the one of least worth and returns which: it may be the same.
    pub fn put(
        &mut self,
        key: NodeKey,
        listed: Option<Worth>,
        brick: LoadedBrick,
    ) -> Option<(NodeKey, Worth)> {
        self.take(key);
        let worth = listed.unwrap_or_else(|| self.left());
        self.order.insert(worth, key);
        self.kept.insert(key, (worth, brick));
        if self.kept.len() <= self.capacity {
            return None;
        }
        let (worth, key) = self.order.pop_first()?;
        self.kept.remove(&key);
        Some((key, worth))
    }

    pub fn take(&mut self, key: NodeKey) -> Option<LoadedBrick> {
        let (worth, brick) = self.kept.remove(&key)?;
        self.order.remove(&worth);
        Some(brick)
    }

    pub fn get(&self, key: NodeKey) -> Option<&LoadedBrick> {
        self.kept.get(&key).map(|(_, brick)| brick)
    }

    /// Rates all bricks by another list; returns how many are wanted now and were not.
    pub fn rate(&mut self, listed: &Listed) -> u64 {
        let before = self.order.split_off(&Worth::LEAST_LISTED);
        for key in before.into_values().filter(|key| !listed.contains_key(key)) {
            let worth = self.left();
            self.order.insert(worth, key);
            self.kept.entry(key).and_modify(|kept| kept.0 = worth);
        }
        let mut hits = 0;
        for (&key, &worth) in listed {
            if let Some((was, _)) = self.kept.get_mut(&key) {
                hits += u64::from(worth.is_wanted() && !was.is_wanted());
                if matches!(was, Worth::Left(_)) {
                    self.order.remove(was);
                }
                *was = worth;
                self.order.insert(worth, key);
            }
        }
        hits
    }

    /// The wanted brick that comes first in its list.
    pub fn take_first_wanted(&mut self) -> Option<(NodeKey, LoadedBrick)> {
        let (&worth, &key) = self.order.last_key_value()?;
        if worth.is_wanted() { self.take(key).map(|brick| (key, brick)) } else { None }
    }

    pub fn has_wanted(&self) -> bool {
        self.order.last_key_value().is_some_and(|(worth, _)| worth.is_wanted())
    }

    fn left(&mut self) -> Worth {
        self.clock += 1;
        Worth::Left(self.clock)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec3;

    fn key(x: u32) -> NodeKey {
        NodeKey { depth: 9, cell: UVec3::new(x, 0, 0) }
    }

    fn brick() -> LoadedBrick {
        LoadedBrick::without_samples(0)
    }

    fn wanted(x: u32) -> Option<Worth> {
        Some(Worth::Wanted(Reverse(x)))
    }

    #[test]
    fn the_worth_of_bricks_is_use_then_rank_then_age() {
        let mut pantry = Pantry::new(3 * SAMPLE_BYTES, 1);
        assert_eq!(pantry.put(key(0), None, brick()), None);
        assert_eq!(pantry.put(key(1), None, brick()), None);
        assert_eq!(pantry.put(key(2), Some(Worth::Prefetched(Reverse(0))), brick()), None);
        assert_eq!(pantry.put(key(3), wanted(5), brick()), Some((key(0), Worth::Left(1))));
        assert_eq!(pantry.put(key(4), wanted(6), brick()), Some((key(1), Worth::Left(2))));
        assert_eq!(pantry.put(key(5), None, brick()), Some((key(5), Worth::Left(3))));
        assert!(!pantry.has_room(Worth::Prefetched(Reverse(1)), 0));
        assert!(pantry.has_room(Worth::Wanted(Reverse(9)), 0));
        assert!(!pantry.has_room(Worth::Wanted(Reverse(9)), 1), "the other one takes the last place");
        assert_eq!(pantry.put(key(6), wanted(7), brick()), Some((key(2), Worth::Prefetched(Reverse(0)))));
        assert_eq!(pantry.put(key(7), wanted(8), brick()), Some((key(7), Worth::Wanted(Reverse(8)))));
        assert_eq!(pantry.bytes(), 3 * SAMPLE_BYTES);
        assert_eq!(pantry.take_first_wanted().map(|(key, _)| key), Some(key(3)));
    }

    #[test]
    fn another_list_rates_anew() {
        let mut pantry = Pantry::new(0, 3);
        for x in 0..3 {
            pantry.put(key(x), wanted(x), brick());
        }
        let listed = Listed::from([(key(2), Worth::Wanted(Reverse(0))), (key(8), Worth::Wanted(Reverse(1)))]);
        assert_eq!(pantry.rate(&listed), 0);
        assert_eq!(pantry.take_first_wanted().map(|(key, _)| key), Some(key(2)));
        assert!(!pantry.has_wanted());
        let listed = Listed::from([(key(0), Worth::Wanted(Reverse(0)))]);
        assert_eq!(pantry.rate(&listed), 1);
        pantry.rate(&Listed::new());
        for x in [5, 6] {
            pantry.put(key(x), None, brick());
        }
        assert!(!pantry.holds(key(1)) && pantry.holds(key(0)), "what was left long ago goes first");
    }
}
