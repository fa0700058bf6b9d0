//! Accuracy measured as a user measures it: on a tiny scene, from the command to the page.

use lightloom_tests::machine;
use lightloom_tests::program::{Ran, files, lightloom, run, small_display, start};
use serde_json::Value;
use std::path::Path;
use std::time::{Duration, Instant};

/// From the signal to the end: a second or so, and a busy machine.
const SOON: Duration = Duration::from_secs(5);

/// `accuracy` of a tiny scene on the small display, with more arguments.
fn accuracy(folder: &Path, scene: &str, rest: &[&str]) -> Ran {
    run(&mut lightloom(&arguments(folder, scene, rest)))
}

fn arguments(folder: &Path, scene: &str, rest: &[&str]) -> Vec<String> {
    let (display, out) = (small_display(folder), folder.join("out").to_string_lossy().into_owned());
    let all = ["accuracy", scene, "--display", &display, "--device", "cpu", "-o", &out];
    all.iter().chain(rest).map(|&word| word.to_owned()).collect()
}

#[test]
fn a_tiny_scene_is_swept_and_told_in_three_ways() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let rest = ["--stride", "3", "--repetitions", "1"];
    let ran = accuracy(folder.path(), "procedural:shells@24", &rest).succeeded();
    let found = files(&folder.path().join("out"));
    assert_eq!(found.keys().collect::<Vec<_>>(), ["accuracy.html", "accuracy.json"]);

    let report: Value = serde_json::from_slice(&found["accuracy.json"]).expect("it is JSON");
    let settings = report["settings"].as_array().expect("there are settings");
    let default = &settings[0];
    assert_eq!(
        (&default["step_voxels"], &default["filter"], &default["bits"]),
        (&0.4.into(), &"exact".into(), &16.into())
    );
    let pixels = report["truth"]["rays"].as_u64().expect("a count");
    assert_eq!(pixels, 2 * 32 * 24);
    for setting in settings {
        let (seconds, rms) = (setting["seconds"].as_f64(), setting["errors"]["rms"].as_f64());
        assert!(seconds.is_some_and(|s| s > 0.0) && rms.is_some_and(|e| e > 0.0 && e < 1.0), "{setting}");
        assert_eq!(setting["errors"]["pixels"], pixels);
    }
    let has = |name: &str, value: Value| settings.iter().any(|setting| setting[name] == value);
    assert!(has("tolerance", Value::Null) && has("bits", 8.into()) && has("lod_scale", 0.0.into()));
    assert!(!has("filter", "hardware".into()), "the CPU has one filter");
    // Steps five times as long without a tolerance are told from the default: an oracle that sees nothing would not.
    let coarse = settings.iter().find(|s| s["step_voxels"] == 2.0 && s["tolerance"].is_null());
    let rms = |setting: &Value| setting["errors"]["rms"].as_f64().unwrap_or(f64::NAN);
    assert!(coarse.is_some_and(|coarse| rms(coarse) > 3.0 * rms(default)), "{coarse:?} and {default}");

    let page = String::from_utf8_lossy(&found["accuracy.html"]).into_owned();
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 3);
    assert!(!page.contains("NaN") && !page.contains("src="), "the page needs something else");
    // A heading, a line for each setting, and what it means.
    assert!(ran.stdout.lines().count() > settings.len() + 4, "{}", ran.stdout);
    assert!(ran.stdout.contains("\ndefault ") && ran.stdout.contains("the default"), "{}", ran.stdout);
}

#[test]
fn json_is_all_that_json_prints() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let rest = ["--stride", "6", "--repetitions", "1", "--projectors", "2", "--json"];
    let ran = accuracy(folder.path(), "procedural:shells@16", &rest).succeeded();
    let report: Value = serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else");
    assert_eq!(report["projectors"], serde_json::json!([2]));
    assert!(ran.stderr.contains("too few"), "{}", ran.stderr);
}

#[test]
fn what_cannot_be_measured_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let refused = |scene: &str, rest: &[&str], parts: &[&str]| {
        accuracy(folder.path(), scene, rest).refused(parts);
        assert!(files(&folder.path().join("out")).is_empty(), "{scene} {rest:?} left files");
    };
    let tiny = "procedural:shells@16";
    refused(tiny, &["--frame", "1"], &["--frame 1", "0..1"]);
    refused(tiny, &["--projectors", "1,4"], &["4 is not one", "from 0 to 3"]);
    refused(tiny, &["--projectors", "1,1"], &["1 twice"]);
    refused(tiny, &["--stride", "1000"], &["--stride 1000"]);
    refused(tiny, &["--repetitions", "2"], &["odd"]);
    refused("procedural:cube", &[], &["cube"]);
    refused("nothing.lloom", &[], &["nothing.lloom"]);
}

#[test]
fn a_signal_ends_it_soon_and_nothing_is_left() {
    machine::alone();
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let rest = ["--full", "--quiet", "--repetitions", "99"];
    let running = start(&mut lightloom(&arguments(folder.path(), "procedural:shells@48", &rest)));
    std::thread::sleep(Duration::from_secs(2));
    let signalled = Instant::now();
    running.interrupt();
    let ran = running.finish(Duration::from_secs(60));
    assert!(signalled.elapsed() < SOON, "{:?}", signalled.elapsed());
    assert_eq!(ran.code, Some(130), "{ran:?}");
    assert!(ran.stderr.starts_with("lightloom: stopped"), "{ran:?}");
    assert!(files(&folder.path().join("out")).is_empty());
}
