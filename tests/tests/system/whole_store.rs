//! A store is whole, or says that it is not: builds that are killed, bytes that change, many readers at once.

use bricks::store::{Store, verify};
use bricks::{BrickSource, NodeKey};
use lightloom_tests::data::{cranium, cranium_raw};
use lightloom_tests::program::{lightloom, run, start};
use lightloom_tests::random::Random;
use rayon::prelude::*;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Builds that are killed before their end.
const KILLS: u32 = 20;
/// Bytes of a store that are changed, one at a time.
const CHANGES: usize = 1000;
/// Stores whose bricks are all read after a change: those where it lies at a multiple of this.
const READ_EVERY: u64 = 4;
/// Programs that read one store at once.
const READERS: usize = 6;

fn import_vessels(out: &Path) -> Command {
    lightloom(&["import", "procedural:sparse-vessels@384", "-o", &out.to_string_lossy(), "--quiet"])
}

/// Kills a program as the system does that is out of memory, or a power cut: nothing can be tidied up.
fn kill_after(wait: Duration, command: &mut Command) {
    let running = start(command);
    std::thread::sleep(wait);
    let sent = Command::new("kill").args(["-9", &running.process().to_string()]).status();
    assert!(sent.is_ok(), "kill is part of every Unix");
    drop(running.finish(Duration::from_secs(60)));
}

/// Killed at any moment, a build leaves no store, or a whole one; and the next build is not hindered.
#[test]
fn a_killed_build_leaves_no_store_that_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("vessels.lloom");
    let started = Instant::now();
    run(&mut import_vessels(&out)).succeeded();
    let mut span_ms = started.elapsed().as_millis() as u64;
    let whole = fs::read(&out).unwrap();
    let mut random = Random(20);
    let (mut killed, mut attempts) = (0, 0);
    while killed < KILLS {
        attempts += 1;
        assert!(attempts <= 5 * KILLS, "only {killed} of {attempts} builds were killed before their end");
        fs::remove_file(&out).unwrap_or(());
        let wait = Duration::from_millis(random.below(span_ms));
        kill_after(wait, &mut import_vessels(&out));
        match fs::read(&out) {
            Ok(bytes) => {
                assert!(bytes == whole, "killed after {wait:?}, it left another store");
                // It was over before: the machine is faster than at first.
                span_ms = (span_ms * 3 / 4).max(20);
            }
            Err(_) => killed += 1,
        }
        for left in fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()) {
            // Killed just before it was given its name, a working file is the whole store.
            let is_sound = || Store::open(&left).is_err() || fs::read(&left).unwrap() == whole;
            assert!(left == out || is_sound(), "{} is no whole store, and opens", left.display());
        }
    }
    println!("{killed} of {attempts} builds were killed before their end, the others after it");
    run(&mut import_vessels(&out)).succeeded();
    assert!(fs::read(&out).unwrap() == whole, "what a killed build left changes nothing");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left");
}

/// A store of a real volume with one byte changed at a time: `verify` finds each, and reading all of it is no panic.
#[test]
fn every_changed_byte_of_a_real_store_is_found() {
    let Some(store) = cranium() else { return };
    let whole = fs::read(store.path()).unwrap();
    assert_eq!(store.verify(&|_, _| {}).damage_count, 0);
    let mut random = Random(1000);
    // Half of them in the header and the table, which are a small part of the file: each brick has an entry of 64 bytes.
    let table = whole.len() as u64 - 64 * store.stored_bricks();
    let mut places: Vec<u64> = (0..CHANGES / 2).map(|_| random.below(whole.len() as u64)).collect();
    places.extend((0..CHANGES / 4).map(|_| random.below(320)));
    places.extend((0..CHANGES / 4).map(|_| table + random.below(whole.len() as u64 - table)));
    let found = places.par_iter().filter(|&&place| {
        let mut bytes = whole.clone();
        bytes[place as usize] ^= 1 << (place % 8);
        match Store::from_bytes(Path::new("changed.lloom"), bytes) {
            Err(_) => true,
            Ok(store) => {
                let root = store.summary(NodeKey::ROOT);
                assert!(root.min <= root.max);
                let damages = store.verify(&|_, _| {}).damages;
                if place % READ_EVERY == 0 {
                    read_all(&store, damages.len());
                }
                !damages.is_empty()
            }
        }
    });
    assert_eq!(found.count(), CHANGES);
}

/// Reads every brick; as many fail at most as damage was found, or those below a damaged entry.
fn read_all(store: &Store, damages: usize) {
    let shape = store.shape();
    let failed = (0..=shape.finest_depth())
        .flat_map(|depth| shape.nodes(depth))
        .filter(|&node| store.brick(node).is_err());
    let failed = failed.count();
    assert!(damages > 0 || failed == 0, "{failed} bricks fail unseen");
}

/// One damaged brick does not stop the others from being shown; many programs read at once.
#[test]
fn many_programs_read_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let Some(raw) = cranium_raw(folder.path()) else { return };
    let store = folder.path().join("cranium.lloom").to_string_lossy().into_owned();
    let raw = raw.to_string_lossy().into_owned();
    let layout = ["--raw-dims", "256,256,108", "--raw-type", "int16", "--quiet"];
    run(&mut lightloom(&[&["import", &raw, "-o", &store], &layout[..]].concat())).succeeded();
    let readers: Vec<_> = (0..READERS).map(|_| start(&mut lightloom(&["verify", &store]))).collect();
    for reader in readers {
        let said = reader.finish(Duration::from_secs(120)).succeeded().stdout;
        assert!(said.contains("whole"), "{said}");
    }
    assert!(verify(Path::new(&store), &|_, _| {}).unwrap().damages.is_empty());
}
