//! `lightloom inputs` with the example that ships, as a laptop without trackers runs it.

use lightloom_tests::program::{lightloom, run, start};
use serde_json::{Value, json};
use std::thread::sleep;
use std::time::Duration;

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../frontend/inputs/examples/inputs.toml");
/// From a signal to the end.
const STOPS_WITHIN: Duration = Duration::from_secs(20);

#[test]
fn a_scripted_wand_is_reported() {
    let ran = run(&mut lightloom(&["inputs", EXAMPLE, "--for", "1.5", "--json"])).succeeded();
    assert_eq!(ran.stderr, "");
    let report: Value = serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else");
    let wand = &report["sources"][0];
    assert_eq!(
        (&wand["name"], &wand["kind"], &wand["is_there"]),
        (&json!("wand"), &json!("script"), &json!(true))
    );
    let sensor = &wand["channels"][0];
    assert_eq!(sensor["channel"], json!({ "sensor": 0 }));
    assert!((sensor["rate_hz"].as_f64().unwrap() - 60.0).abs() < 0.1, "{sensor}");
}

#[test]
fn who_interrupts_it_gets_the_table() {
    let running = start(&mut lightloom(&["inputs", EXAMPLE]));
    sleep(Duration::from_secs(1));
    running.interrupt();
    let ran = running.finish(STOPS_WITHIN).succeeded();
    assert!(
        ran.stdout.contains("wand: its script runs") && ran.stdout.contains("sensor 0"),
        "{}",
        ran.stdout
    );
}

#[test]
fn files_that_are_none_are_refused_in_a_sentence() {
    let refused = |file: &str, parts: &[&str]| run(&mut lightloom(&["inputs", file])).refused(parts);
    refused("/no/such.toml", &["cannot read the input file /no/such.toml"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml").to_string_lossy().into_owned();
    std::fs::write(&path, "[[input]]\nname = \"wand\"\nkind = \"vrpn\"\nadress = \"host\"\n").unwrap();
    refused(&path, &["line 4, input `wand`", "`adress` is not a key of kind vrpn (did you mean `address`?)"]);
}
