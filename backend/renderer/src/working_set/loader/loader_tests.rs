//! Laws of the loader: order, cancellation, no read in vain, and a slow disk holds nothing up.

use super::test_source::{TestSource, Trouble, key, keys};
use super::*;
use bricks::BrickErrorKind;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

const PANTRY_BYTES: u64 = 100 * SAMPLE_BYTES;
/// Longer than any test may take: a longer wait is in vain.
const LONG: Duration = Duration::from_secs(60);

fn loader(source: &Arc<TestSource>, threads: usize) -> Loader {
    Loader::new(Arc::clone(source) as Arc<dyn BrickSource>, threads, PANTRY_BYTES)
}

/// The next `count` that arrive, in order.
#[track_caller]
fn take(loader: &Loader, count: usize) -> Vec<Fetched> {
    let mut taken = Vec::new();
    while taken.len() < count {
        assert!(loader.wait(LONG), "{count} are expected, {} came", taken.len());
        taken.extend(loader.arrived(u64::MAX));
    }
    taken
}

/// Waits until all is read that will be.
#[track_caller]
fn settle(loader: &Loader) {
    let started = Instant::now();
    while !loader.is_idle() {
        assert!(started.elapsed() < LONG, "{:?}", loader.counts());
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn names(fetched: &[Fetched]) -> Vec<u32> {
    fetched.iter().map(|(key, _)| key.cell.x).collect()
}

#[test]
fn first_things_are_read_first_and_another_order_holds_at_once() {
    let source = TestSource::held();
    let loader = loader(&source, 1);
    assert_eq!(loader.want(&keys([3, 1, 2, 4]), &[]), 0);
    source.wait_inside(1);
    assert_eq!(loader.want(&keys([4, 2, 3, 1]), &[]), 0);
    source.release();
    settle(&loader);
    assert_eq!(source.begun(), keys([3, 4, 2, 1]));
    let arrived = loader.arrived(u64::MAX);
    assert_eq!(names(&arrived), [4, 2, 3, 1]);
    for (key, brick) in arrived {
        let brick = brick.unwrap();
        assert_eq!((brick.low, brick.span, brick.bytes), (f64::from(key.cell.x), 255.0, SAMPLE_BYTES / 2));
        assert!(brick.samples.iter().all(|&sample| sample == u16::MAX));
    }
}

#[test]
fn what_is_wanted_no_more_is_cancelled_and_what_was_read_is_kept() {
    let source = TestSource::held();
    let loader = loader(&source, 1);
    loader.want(&keys([0, 1, 2, 3]), &keys([4, 5]));
    source.wait_inside(1);
    assert_eq!((loader.in_flight(), loader.counts().queued), (1, 5));
    // 1 and 5 go; 0 is being read.
    assert_eq!(loader.want(&keys([3]), &keys([2, 4])), 2);
    source.release();
    assert_eq!(names(&take(&loader, 1)), [3]);
    settle(&loader);
    assert_eq!(source.begun(), keys([0, 3, 2, 4]));
    assert!(loader.arrived(u64::MAX).is_empty(), "nobody asks for the others");
    assert_eq!(loader.counts().kept_bytes, 3 * SAMPLE_BYTES);

    source.hold();
    loader.want(&keys([4, 0]), &[]);
    assert_eq!(names(&loader.arrived(u64::MAX)), [4, 0]);
    assert_eq!(source.begun().len(), 4, "they were there");
    let counts = loader.counts();
    assert_eq!((counts.reads, counts.hits, counts.cancelled), (4, 2, 2));
    source.release();
}

#[test]
fn no_brick_is_read_twice_at_a_time() {
    let source = TestSource::held();
    let loader = loader(&source, 4);
    loader.want(&keys([0, 1]), &[]);
    source.wait_inside(2);
    loader.want(&[], &keys([0, 1]));
    loader.want(&keys([1, 0, 1]), &keys([0, 1]));
    std::thread::scope(|scope| {
        let waits = scope.spawn(|| {
            let mut fetched = Vec::new();
            loader.fetch(&keys([0, 2]), |brick| fetched.push(brick)).unwrap();
            fetched.sort_by_key(|(key, _)| *key);
            names(&fetched)
        });
        source.wait_inside(3);
        source.release();
        assert_eq!(waits.join().unwrap(), [0, 2]);
    });
    let mut taken = names(&take(&loader, 2));
    taken.sort();
    assert_eq!((taken, loader.arrived(u64::MAX).len()), (vec![0, 1], 0));
    assert_eq!(source.begun().len(), 3);
    assert!(!source.has_doubled());
}

#[test]
fn no_call_hands_over_more_than_it_may() {
    let source = TestSource::shared();
    let loader = loader(&source, 3);
    source.spoil(key(4), Some(Trouble::Unavailable));
    loader.want(&keys(0..6), &[]);
    settle(&loader);
    // A failure takes no bytes.
    assert_eq!(names(&loader.arrived(3 * SAMPLE_BYTES - 1)), [0, 1, 4]);
    assert_eq!(names(&loader.arrived(0)), [2]);
    loader.want(&keys([5, 3]), &[]);
    assert_eq!(names(&loader.arrived(u64::MAX)), [5, 3]);
    assert!(loader.arrived(u64::MAX).is_empty() && !loader.wait(LONG));
    assert_eq!(source.begun().len(), 6);
}

/// The gate stays shut to the end: that this test ends at all is what it shows.
#[test]
fn a_disk_that_does_not_answer_holds_up_nobody() {
    let source = TestSource::held();
    let loader = loader(&source, 2);
    for round in 0..100 {
        loader.want(&keys(round..round + 50), &keys(round + 50..round + 60));
        assert!(loader.arrived(u64::MAX).is_empty());
    }
    source.wait_inside(2);
    assert!(!loader.wait(Duration::from_millis(1)) && !loader.is_idle());
    assert_eq!(loader.in_flight(), 2);
    drop(loader);
    assert_eq!(source.begun().len(), 2);
    assert_eq!(Arc::strong_count(&source), 3, "both threads are inside a read, left to themselves");
    source.release();
    let started = Instant::now();
    while Arc::strong_count(&source) > 1 {
        assert!(started.elapsed() < LONG, "they end with their reads");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(source.begun().len(), 2, "and begin no other");
}

#[test]
fn a_loader_s_threads_end_with_it() {
    let source = TestSource::shared();
    let loader = loader(&source, 5);
    loader.want(&keys(0..3), &[]);
    take(&loader, 3);
    drop(loader);
    assert_eq!(Arc::strong_count(&source), 1);
}

#[test]
fn each_failure_is_told_once() {
    let source = TestSource::shared();
    let loader = loader(&source, 2);
    source.spoil(key(0), Some(Trouble::Unavailable));
    source.spoil(key(1), Some(Trouble::Panic));
    source.spoil(key(2), Some(Trouble::Short));
    for round in 1..3 {
        loader.want(&keys(0..4), &keys([9]));
        settle(&loader);
        // The list again, before the failure was reported: no reason to read again.
        loader.want(&keys(0..4), &keys([9]));
        let arrived = loader.arrived(u64::MAX);
        let kinds: Vec<_> = arrived.iter().map(|(_, brick)| brick.as_ref().err().map(|e| e.kind)).collect();
        let (away, damaged) = (Some(BrickErrorKind::Unavailable), Some(BrickErrorKind::Damaged));
        assert_eq!((names(&arrived), kinds), (vec![0, 1, 2, 3], vec![away, damaged, damaged, None]));
        assert!(loader.arrived(u64::MAX).is_empty());
        assert_eq!(loader.counts().failures, 3 * round);
    }
    source.spoil(key(0), None);
    loader.want(&keys([0]), &[]);
    assert!(take(&loader, 1)[0].1.is_ok());
}

#[test]
fn failures_of_what_nobody_waits_for_are_told_too() {
    let source = TestSource::held();
    let loader = loader(&source, 3);
    keys([0, 1]).into_iter().for_each(|key| source.spoil(key, Some(Trouble::Unavailable)));
    loader.want(&keys([0]), &[]);
    source.wait_inside(1);
    loader.want(&[], &keys([1, 2]));
    source.release();
    settle(&loader);
    loader.want(&[], &keys([1, 2]));
    settle(&loader);
    assert_eq!(source.begun().len(), 3, "nothing is read again before the failure was reported");
    assert_eq!(names(&loader.arrived(0)), [1, 0]);
    assert!(loader.arrived(0).is_empty());
}

#[test]
fn prefetching_leaves_a_thread_free() {
    let source = TestSource::held();
    let loader = loader(&source, 3);
    loader.want(&[], &keys(0..9));
    source.wait_inside(2);
    loader.want(&keys([50]), &keys(0..9));
    source.wait_inside(3);
    assert_eq!(source.begun()[2], key(50));
    source.release();
    assert_eq!(names(&take(&loader, 1)), [50]);
    settle(&loader);
    assert_eq!(source.begun().len(), 10);
}

/// What may be wanted soon is not read in turns when it does not fit; what is wanted takes its place.
#[test]
fn a_small_pantry_is_filled_once() {
    let source = TestSource::shared();
    let loader = Loader::new(Arc::clone(&source) as Arc<dyn BrickSource>, 2, 4 * SAMPLE_BYTES);
    for _ in 0..3 {
        loader.want(&[], &keys(0..20));
        settle(&loader);
    }
    assert_eq!((source.begun(), loader.counts().kept_bytes), (keys(0..4), 4 * SAMPLE_BYTES));
    loader.want(&keys(10..20), &[]);
    settle(&loader);
    assert_eq!(loader.counts().kept_bytes, 4 * SAMPLE_BYTES);
    assert_eq!(names(&loader.arrived(u64::MAX)), [10, 11, 12, 13]);
    let mut rest = names(&take(&loader, 6));
    rest.sort();
    assert_eq!(rest, [14, 15, 16, 17, 18, 19]);
    assert_eq!(source.begun().len(), 14);
}

#[test]
fn a_complete_frame_waits_for_all_and_takes_nothing_from_a_live_one() {
    let source = TestSource::shared();
    let loader = loader(&source, 2);
    source.spoil(key(7), Some(Trouble::Panic));
    loader.want(&keys([0, 1]), &[]);
    let mut fetched = BTreeMap::new();
    let arrived = |(key, brick): Fetched| fetched.extend([(key.cell.x, brick.is_ok())]);
    loader.fetch(&keys([1, 2, 7]), arrived).unwrap();
    assert_eq!(fetched, BTreeMap::from([(1, true), (2, true), (7, false)]));
    let mut taken = names(&take(&loader, 2));
    taken.sort();
    assert_eq!(taken, [0, 1]);
    assert!(loader.arrived(u64::MAX).is_empty(), "the failure is the complete frame's");
    loader.fetch(&[], |_| panic!("nothing was asked for")).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever was asked for before, all of a list that stays comes once, whole or as a failure.
    #[test]
    fn all_of_a_list_that_stays_comes_once(
        lists in prop::collection::vec((prop::collection::vec(0..24u32, 0..12), prop::collection::vec(0..24u32, 0..6)), 1..12),
        threads in 1..5usize, bricks in 0..12u64, most in 0..3u64,
    ) {
        let source = TestSource::shared();
        keys([3, 11]).into_iter().for_each(|key| source.spoil(key, Some(Trouble::Unavailable)));
        let loader = Loader::new(Arc::clone(&source) as Arc<dyn BrickSource>, threads, bricks * SAMPLE_BYTES);
        for (ordered, prefetch) in &lists {
            loader.want(&keys(ordered.iter().copied()), &keys(prefetch.iter().copied()));
            loader.arrived(most * SAMPLE_BYTES);
        }
        let last: Vec<u32> = (0..24).rev().step_by(2).collect();
        loader.want(&keys(last.iter().copied()), &[]);
        let mut came = BTreeSet::new();
        while loader.wait(LONG) {
            for (key, brick) in loader.arrived(most * SAMPLE_BYTES) {
                let is_failure = matches!(key.cell.x, 3 | 11);
                prop_assert_eq!(brick.is_err(), is_failure);
                // A failure may be an earlier read's.
                prop_assert!(last.contains(&key.cell.x) || is_failure);
                prop_assert!(came.insert(key.cell.x), "{key} came twice");
            }
        }
        prop_assert!(last.iter().all(|x| came.contains(x)), "{came:?}");
        prop_assert!(!source.has_doubled() && loader.is_idle());
    }
}
