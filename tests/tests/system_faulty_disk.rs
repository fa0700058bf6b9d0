//! The loader on a disk that fails: what can be had comes, what cannot is told, and nobody waits.

use bricks::{BrickErrorKind, BrickSource, NodeKey};
use glam::UVec3;
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::faulty_source::{FOR_EVER, Fault, FaultySource, Rates};
use renderer::working_set::{Loader, Retry};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// Longer than any wait here may be.
const LONG: Duration = Duration::from_secs(60);
const SEED: u64 = 0x5eed;

fn faulty(rates: Rates) -> Arc<FaultySource> {
    let volume = ClosureVolume::new(UVec3::splat(28 * 4), (0.0, 1.0), |point| point.x / 112.0);
    FaultySource::shared(Arc::new(volume), SEED, rates)
}

fn loader(source: &Arc<FaultySource>) -> Loader {
    Loader::new(Arc::clone(source) as Arc<dyn BrickSource>, 4, 64 << 20)
}

fn nodes(source: &FaultySource) -> Vec<NodeKey> {
    let shape = source.shape();
    (0..=2).flat_map(|depth| shape.nodes(depth)).collect()
}

/// What is left of a list when a clock that leaps from wait to wait stands still.
fn load_all(
    source: &Arc<FaultySource>,
    until_s: f64,
) -> (BTreeSet<NodeKey>, BTreeMap<NodeKey, BrickErrorKind>) {
    let (loader, mut retry, mut now) = (loader(source), Retry::new(), 0.0);
    let mut lacking = nodes(source);
    let mut failures = BTreeMap::new();
    loop {
        let list: Vec<NodeKey> = lacking.iter().copied().filter(|&key| retry.may_ask(key, now)).collect();
        loader.want(&list, &[]);
        while loader.wait(LONG) {
            for (key, brick) in loader.arrived(u64::MAX) {
                match brick {
                    Ok(_) => {
                        lacking.retain(|&lacked| lacked != key);
                        retry.came(key);
                        failures.remove(&key);
                    }
                    Err(error) => {
                        retry.failed(key, error.kind, now);
                        failures.insert(key, error.kind);
                    }
                }
            }
        }
        match retry.next(now).filter(|&at| at <= until_s) {
            Some(at) => now = at,
            None => return (lacking.into_iter().collect(), failures),
        }
    }
}

#[test]
fn what_a_disk_refuses_for_a_while_comes_and_what_is_damaged_is_read_once() {
    let rates = vec![
        (Fault::Away(1), 100),
        (Fault::Away(3), 100),
        (Fault::Away(FOR_EVER), 100),
        (Fault::Late(Duration::from_millis(30)), 100),
        (Fault::Damaged, 80),
        (Fault::Short, 80),
        (Fault::Panic, 80),
    ];
    let source = faulty(rates.clone());
    println!("seed {SEED:#x}");
    let (lacking, failures) = load_all(&source, 200.0);
    for (fault, _) in rates {
        let mut with = nodes(&source);
        with.retain(|&node| source.fault(node) == Some(fault));
        assert!(!with.is_empty(), "no brick has {fault:?}");
        for node in with {
            // Tries at 0, 1, 3, 7, 15, 31, 63, 123 and 183 s.
            let (reads, kind) = match fault {
                Fault::Away(FOR_EVER) => (9, Some(BrickErrorKind::Unavailable)),
                Fault::Away(times) => (times + 1, None),
                Fault::Late(_) => (1, None),
                Fault::Damaged | Fault::Short | Fault::Panic => (1, Some(BrickErrorKind::Damaged)),
            };
            assert_eq!(source.reads_of(node), reads, "{fault:?}");
            assert_eq!((failures.get(&node).copied(), lacking.contains(&node)), (kind, kind.is_some()));
        }
    }
    assert_eq!(lacking.len(), failures.len());
    assert!(!source.has_doubled());
}

#[test]
fn a_disk_that_comes_back_gives_all() {
    let source = faulty(Vec::new());
    source.set_away(true);
    let (lacking, failures) = load_all(&source, 0.0);
    assert_eq!((lacking.len(), failures.len()), (73, 73));
    source.set_away(false);
    assert!(load_all(&source, 0.0).0.is_empty());
}

/// Nothing here asks for the time: the calls return although the disk does not.
#[test]
fn a_disk_that_hangs_holds_up_neither_frames_nor_the_end() {
    let source = faulty(Vec::new());
    source.hold();
    let loader = loader(&source);
    let nodes = nodes(&source);
    for frame in 0..nodes.len() {
        loader.want(&nodes[frame..], &nodes[..frame]);
        assert!(loader.arrived(u64::MAX).is_empty());
    }
    // All threads hang, and not on what is fetched ahead alone, which leaves one free.
    loader.want(&nodes, &[]);
    source.wait_inside(4);
    assert_eq!(source.reads(), 4);
    drop(loader);
    source.release();
}
