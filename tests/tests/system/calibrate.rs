//! Where a tracker is, as a user measures it.

use lightloom_tests::program::{Ran, lightloom, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Marks on a screen and one before it: as a tracker sees them that is turned by 90° about y, and where they are.
const MARKS: [([f64; 3], [f64; 3]); 5] = [
    ([2.0, -0.45, -0.8], [-0.8, -0.45, 0.0]),
    ([2.0, -0.45, 0.8], [0.8, -0.45, 0.0]),
    ([2.0, 0.45, 0.8], [0.8, 0.45, 0.0]),
    ([2.0, 0.45, -0.8], [-0.8, 0.45, 0.0]),
    ([1.5, 0.0, 0.0], [0.0, 0.0, 0.5]),
];

fn calibrated(folder: &Path, marks: &[([f64; 3], [f64; 3])], more: &[&str]) -> Ran {
    let pair = |(tracker, display)| format!("[[pair]]\ntracker_m = {tracker:?}\ndisplay_m = {display:?}\n");
    let pairs = folder.join("pairs.toml");
    fs::write(&pairs, marks.iter().copied().map(pair).collect::<String>()).unwrap();
    run(&mut lightloom(&[&["calibrate", "tracker", &pairs.to_string_lossy()], more].concat()))
}

#[test]
fn a_tracker_s_place_is_found_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("tracker.toml");
    let out = out.to_string_lossy();
    let said =
        calibrated(folder.path(), &MARKS, &["--out", &out, "--display", "holo72", "--json"]).succeeded();
    assert_eq!(said.stderr, "");
    let said: Value = serde_json::from_str(&said.stdout).unwrap();
    let numbers = |key: &str| -> Vec<f64> { serde_json::from_value(said[key].clone()).unwrap() };
    let half = 0.5_f64.sqrt();
    let found = [numbers("rotation"), numbers("translation_m")].concat();
    let expected = [0.0, half, 0.0, half, 0.0, 0.0, 2.0];
    assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12), "{said}");
    let written = fs::read_to_string(&*out).unwrap();
    for key in ["rotation", "translation_m"] {
        // A list of numbers reads alike in TOML and JSON.
        let list = written.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
        assert_eq!(serde_json::from_str::<Vec<f64>>(list.unwrap()).unwrap(), numbers(key), "{written}");
    }
    let flat = calibrated(folder.path(), &MARKS[..4], &[]).succeeded();
    assert!(flat.stderr.contains("left-handed") && flat.stdout.contains("rotation = ["), "{flat:?}");
}

#[test]
fn pairs_that_fix_no_place_are_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |marks: &[([f64; 3], [f64; 3])], part: &str| {
        calibrated(folder.path(), marks, &[]).refused(&["pairs.toml", part]);
    };
    let with = |change: fn([f64; 3]) -> [f64; 3]| MARKS.map(|(tracker, display)| (change(tracker), display));
    refused(&MARKS[..2], "2 point pairs");
    refused(&with(|[x, y, z]| [1e3 * x, 1e3 * y, 1e3 * z]), "millimetres");
    refused(&with(|[x, y, z]| [x, y, -z]), "left-handed");
    refused(&with(|[x, y, z]| if z > y { [x, y, z + 0.7] } else { [x, y, z] }), "do not fit");
    let mut wrong = MARKS;
    wrong[4].0[1] = 0.6;
    refused(&wrong, "pair `pair 5`");
    refused(&MARKS.map(|(_, display)| ([display[0], 0.0, 0.0], display)), "the same tracker point");
}
