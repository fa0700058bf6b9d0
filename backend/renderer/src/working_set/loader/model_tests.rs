//! The queue against a model that looks through lists: what is begun, cancelled and handed over, step by step.

use super::queue::Queue;
use super::test_source::keys;
use super::{LoadedBrick, SAMPLE_BYTES};
use bricks::{BrickError, NodeKey};
use proptest::prelude::*;
use std::collections::HashSet;

const THREADS: usize = 3;

#[derive(Clone, Debug)]
enum Step {
    Want(Vec<u32>, Vec<u32>),
    Begin,
    Finish(usize, bool),
    Arrived(u64),
}

fn step() -> impl Strategy<Value = Step> {
    let list = |most| prop::collection::vec(0..16u32, 0..most);
    prop_oneof![
        2 => (list(10), list(6)).prop_map(|(ordered, prefetch)| Step::Want(ordered, prefetch)),
        5 => Just(Step::Begin),
        4 => (0..THREADS, prop::bool::weighted(0.8)).prop_map(|(which, is_good)| Step::Finish(which, is_good)),
        2 => (0..4u64).prop_map(Step::Arrived),
    ]
}

fn brick() -> LoadedBrick {
    LoadedBrick::without_samples(0)
}

/// Without bounds of memory.
#[derive(Debug, Default)]
struct Model {
    ordered: Vec<NodeKey>,
    prefetch: Vec<NodeKey>,
    reading: Vec<NodeKey>,
    there: HashSet<NodeKey>,
    failed: HashSet<NodeKey>,
}

impl Model {
    fn is_unread(&self, key: &NodeKey) -> bool {
        !self.reading.contains(key) && !self.there.contains(key) && !self.failed.contains(key)
    }

    fn want(&mut self, ordered: &[NodeKey], prefetch: &[NodeKey]) -> usize {
        let is_listed = |key: &NodeKey| ordered.contains(key) || prefetch.contains(key);
        let listed: HashSet<_> = self.ordered.iter().chain(&self.prefetch).copied().collect();
        let cancelled = listed.iter().filter(|key| self.is_unread(key) && !is_listed(key)).count();
        (self.ordered, self.prefetch) = (distinct(ordered), distinct(prefetch));
        cancelled
    }

    fn begin(&mut self) -> Option<NodeKey> {
        let first = |list: &[NodeKey]| list.iter().copied().find(|key| self.is_unread(key));
        let may_prefetch = self.reading.len() + 1 < THREADS;
        let next = first(&self.ordered).or_else(|| first(&self.prefetch).filter(|_| may_prefetch));
        self.reading.extend(next);
        next
    }

    fn arrived(&mut self, most: u64) -> Vec<(NodeKey, bool)> {
        let mut left = most.max(1);
        let mut come = Vec::new();
        let mut listed = self.ordered.clone();
        listed.extend(self.prefetch.iter().filter(|key| !self.ordered.contains(key)));
        for key in listed {
            if self.failed.remove(&key) {
                come.push((key, false));
            } else if self.ordered.contains(&key) && left > 0 && self.there.remove(&key) {
                left -= 1;
                come.push((key, true));
            }
        }
        let mut rest: Vec<NodeKey> = self.failed.drain().collect();
        rest.sort();
        come.extend(rest.into_iter().map(|key| (key, false)));
        let is_left = |key: &NodeKey| come.iter().all(|(gone, _)| gone != key);
        self.ordered.retain(is_left);
        self.prefetch.retain(is_left);
        come
    }
}

fn distinct(list: &[NodeKey]) -> Vec<NodeKey> {
    let mut seen = HashSet::new();
    list.iter().copied().filter(|&key| seen.insert(key)).collect()
}

fn arrived(queue: &mut Queue, most: u64) -> Vec<(NodeKey, bool)> {
    queue.arrived(most * SAMPLE_BYTES).into_iter().map(|(key, brick)| (key, brick.is_ok())).collect()
}

fn finish(queue: &mut Queue, key: NodeKey, is_good: bool) {
    queue.finish(key, if is_good { Ok(brick()) } else { Err(BrickError::unavailable("no")) });
}

/// The first step at which a queue differs from the model.
fn first_difference(mut queue: Queue, steps: &[Step]) -> Option<usize> {
    let mut model = Model::default();
    let is_same = |step: &Step| match step {
        Step::Want(ordered, prefetch) => {
            let (ordered, prefetch) = (keys(ordered.iter().copied()), keys(prefetch.iter().copied()));
            queue.want(&ordered, &prefetch) == model.want(&ordered, &prefetch)
        }
        Step::Begin => model.reading.len() == THREADS || queue.begin() == model.begin(),
        Step::Finish(which, is_good) if *which < model.reading.len() => {
            let key = model.reading.remove(*which);
            if *is_good {
                model.there.insert(key)
            } else {
                model.failed.insert(key)
            };
            finish(&mut queue, key, *is_good);
            true
        }
        Step::Finish(..) => true,
        Step::Arrived(most) => arrived(&mut queue, *most) == model.arrived(*most),
    };
    let same: Vec<bool> = steps.iter().map(is_same).collect();
    same.iter().position(|&is_same| !is_same)
}

/// The canary: a queue with little room differs when it is full, and is found out.
#[test]
fn a_queue_that_stops_is_not_the_model_s() {
    let read = [Step::Begin, Step::Finish(0, true)];
    let steps: Vec<Step> = [Step::Want((0..9).collect(), Vec::new())]
        .into_iter()
        .chain(read.into_iter().cycle().take(12))
        .collect();
    assert_eq!(first_difference(Queue::new(THREADS, 1 << 30), &steps), None);
    assert_eq!(first_difference(Queue::new(THREADS, 0), &steps), Some(1 + 2 * THREADS));
}

proptest! {
    /// With room for all, every step is the model's.
    #[test]
    fn every_step_is_the_model_s(steps in prop::collection::vec(step(), 1..120)) {
        prop_assert_eq!(first_difference(Queue::new(THREADS, 1 << 30), &steps), None);
    }

    /// With little room bricks may be read again, but none is lost: all of the last list comes, once.
    #[test]
    fn little_room_loses_nothing(steps in prop::collection::vec(step(), 1..120), bricks in 0..6u64) {
        let mut queue = Queue::new(THREADS, bricks * SAMPLE_BYTES);
        let mut reading: Vec<NodeKey> = Vec::new();
        let mut owed: Vec<NodeKey> = Vec::new();
        for step in steps {
            match step {
                Step::Want(ordered, prefetch) => {
                    let [ordered, prefetch] = [ordered, prefetch].map(keys);
                    queue.want(&ordered, &prefetch);
                    owed = ordered;
                }
                Step::Begin if reading.len() < THREADS => {
                    let begun = queue.begin();
                    prop_assert!(begun.is_none_or(|key| !reading.contains(&key)));
                    reading.extend(begun);
                }
                Step::Finish(which, is_good) if which < reading.len() => {
                    finish(&mut queue, reading.remove(which), is_good);
                }
                Step::Arrived(most) => {
                    let come = arrived(&mut queue, most);
                    prop_assert!(come.iter().all(|(key, is_good)| !is_good || owed.contains(key)));
                    owed.retain(|key| come.iter().all(|(gone, _)| gone != key));
                }
                Step::Begin | Step::Finish(..) => {}
            }
            prop_assert!(queue.counts().kept_bytes <= bricks.max(THREADS as u64) * SAMPLE_BYTES);
        }
        let mut owed: HashSet<NodeKey> = owed.into_iter().collect();
        loop {
            while reading.len() < THREADS && let Some(key) = queue.begin() {
                reading.push(key);
            }
            reading.drain(..).for_each(|key| finish(&mut queue, key, true));
            let come = arrived(&mut queue, 1);
            for (key, is_good) in &come {
                prop_assert!(owed.remove(key) || !is_good, "{key} was not owed");
            }
            if come.is_empty() && queue.is_idle() {
                break;
            }
        }
        prop_assert!(owed.is_empty(), "{owed:?} never came");
    }
}
