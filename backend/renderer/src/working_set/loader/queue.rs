//! The queue: what is to be read next, what is being read, what has come.

use super::load::{Fetched, LoadedBrick, SAMPLE_BYTES};
use super::pantry::{Listed, Pantry, Worth};
use bricks::{BrickError, NodeKey};
use crossbeam_channel::Sender;
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};

/// What the loader did since it was made, and does now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoaderCounts {
    /// Bricks being read.
    pub in_flight: usize,
    /// Bricks that are wanted, or may be soon, and whose reading has not begun.
    pub queued: usize,
    /// Bytes of the samples that were read and not yet taken.
    pub kept_bytes: u64,
    /// Reads that began.
    pub reads: u64,
    /// Reads that failed.
    pub failures: u64,
    /// Bricks that had been read when they came to be wanted.
    pub hits: u64,
    /// Bricks that were queued and are wanted no more.
    pub cancelled: u64,
}

/// Knows no thread and no file: a thread asks what to read, and returns what came of it.
#[derive(Debug)]
pub(in crate::working_set) struct Queue {
    threads: usize,
    /// For callers that wait: these go first.
    errands: VecDeque<NodeKey>,
    callers: HashMap<NodeKey, Vec<Sender<Fetched>>>,
    listed: Listed,
    /// The listed keys of which nothing is known yet.
    unread: BTreeMap<Worth, NodeKey>,
    reading: HashSet<NodeKey>,
    /// Why reads failed, for failures not yet reported.
    failed: HashMap<NodeKey, BrickError>,
    pantry: Pantry,
    counts: LoaderCounts,
}

impl Queue {
    /// For so many threads; every one of them may always put one brick into the pantry.
    pub fn new(threads: usize, pantry_bytes: u64) -> Self {
        Self {
            threads,
            errands: VecDeque::new(),
            callers: HashMap::new(),
            listed: Listed::new(),
            unread: BTreeMap::new(),
            reading: HashSet::new(),
            failed: HashMap::new(),
            pantry: Pantry::new(pantry_bytes, threads),
            counts: LoaderCounts::default(),
        }
    }

    /// See [`super::Loader::want`].
    pub fn want(&mut self, ordered: &[NodeKey], prefetch: &[NodeKey]) -> usize {
        let mut listed = Listed::with_capacity(ordered.len() + prefetch.len());
        for (rank, &key) in (0..).zip(ordered) {
            listed.entry(key).or_insert(Worth::Wanted(Reverse(rank)));
        }
        for (rank, &key) in (0..).zip(prefetch) {
            listed.entry(key).or_insert(Worth::Prefetched(Reverse(rank)));
        }
        let before = std::mem::take(&mut self.unread);
        let cancelled = before.values().filter(|key| !listed.contains_key(key)).count();
        self.counts.cancelled += cancelled as u64;
        self.counts.hits += self.pantry.rate(&listed);
        let is_unknown = |key: NodeKey| {
            !self.reading.contains(&key) && !self.failed.contains_key(&key) && !self.pantry.holds(key)
        };
        let unread = listed.iter().filter(|&(&key, _)| is_unknown(key));
        self.unread = unread.map(|(&key, &worth)| (worth, key)).collect();
        self.listed = listed;
        cancelled
    }

    /// A caller waits for a brick. One that is there or being read is not read again.
    pub fn fetch(&mut self, key: NodeKey, caller: &Sender<Fetched>) {
        // A copy where the live list wants it, too: neither takes a brick from the other.
        let kept = match self.listed.contains_key(&key) {
            true => self.pantry.get(key).cloned(),
            false => self.pantry.take(key),
        };
        if let Some(brick) = kept {
            self.counts.hits += 1;
            // A caller that has gone needs no brick.
            let _ = caller.send((key, Ok(brick)));
            return;
        }
        let callers = self.callers.entry(key).or_default();
        if callers.is_empty() && !self.reading.contains(&key) {
            self.errands.push_back(key);
        }
        callers.push(caller.clone());
    }

    /// The next brick to read, if any: it counts as being read from now on.
    pub fn begin(&mut self) -> Option<NodeKey> {
        let key = self.next()?;
        if self.errands.front() == Some(&key) {
            self.errands.pop_front();
        }
        if let Some(worth) = self.listed.get(&key) {
            self.unread.remove(worth);
        }
        self.reading.insert(key);
        self.counts.reads += 1;
        Some(key)
    }

    fn next(&self) -> Option<NodeKey> {
        if let Some(&key) = self.errands.front() {
            return Some(key);
        }
        let (&worth, &key) = self.unread.last_key_value()?;
        // A brick that cannot stay would be read in vain, and again.
        let may_stay = self.pantry.has_room(worth, self.reading.len());
        // What may be wanted later must not hold all threads, should the disk be slow: one stays free for what is
        // wanted now.
        let may_start = worth.is_wanted() || self.threads == 1 || self.reading.len() + 1 < self.threads;
        (may_stay && may_start).then_some(key)
    }

    /// What came of a brick that was being read.
    pub fn finish(&mut self, key: NodeKey, result: Result<LoadedBrick, BrickError>) {
        self.reading.remove(&key);
        self.counts.failures += u64::from(result.is_err());
        let listed = self.listed.get(&key).copied();
        let callers = self.callers.remove(&key).unwrap_or_default();
        for caller in &callers {
            // A caller that has gone needs no brick.
            let _ = caller.send((key, result.clone()));
        }
        if listed.is_none() && !callers.is_empty() {
            return;
        }
        match result {
            Ok(brick) => self.keep(key, listed, brick),
            Err(error) => drop(self.failed.insert(key, error)),
        }
    }

    /// Puts a brick into the pantry. What has to go for it and is listed is read again when there is room.
    fn keep(&mut self, key: NodeKey, listed: Option<Worth>, brick: LoadedBrick) {
        // A caller's read may have got what an earlier one could not.
        self.failed.remove(&key);
        if let Some((gone, worth)) = self.pantry.put(key, listed, brick)
            && self.listed.contains_key(&gone)
        {
            self.unread.insert(worth, gone);
        }
    }

    /// See [`super::Loader::arrived`].
    pub fn arrived(&mut self, most_bytes: u64) -> Vec<Fetched> {
        let failed = self.failed.drain().map(|(key, error)| (key, Err(error)));
        let mut arrived: Vec<Fetched> = failed.collect();
        for _ in 0..(most_bytes / SAMPLE_BYTES).max(1) {
            let Some((key, brick)) = self.pantry.take_first_wanted() else { break };
            arrived.push((key, Ok(brick)));
        }
        let listed = |key: &NodeKey| self.listed.get(key).copied();
        arrived.sort_by(|(a, _), (b, _)| listed(b).cmp(&listed(a)).then_with(|| a.cmp(b)));
        for (key, _) in &arrived {
            self.listed.remove(key);
        }
        arrived
    }

    /// Whether [`Queue::arrived`] would return anything.
    pub fn has_news(&self) -> bool {
        !self.failed.is_empty() || self.pantry.has_wanted()
    }

    /// Whether nothing is being read, nor will be as things are.
    pub fn is_idle(&self) -> bool {
        self.reading.is_empty() && self.next().is_none()
    }

    pub fn counts(&self) -> LoaderCounts {
        LoaderCounts {
            in_flight: self.reading.len(),
            queued: self.unread.len() + self.errands.len(),
            kept_bytes: self.pantry.bytes(),
            ..self.counts
        }
    }

    /// Nothing is wanted any more; waiting callers see the end of their channel.
    pub fn close(&mut self) {
        self.errands.clear();
        self.callers.clear();
        self.want(&[], &[]);
    }
}
