//! Working sets that `simulate --live --trace` records and `replay` tries under other policies.

use lightloom_tests::program::{files, lightloom, run, scene_of_skins, small_display};
use serde_json::Value;
use std::fs;
use std::path::Path;

const FRAMES: u64 = 20;
const BACKENDS: u64 = 2;

/// A turning volume.
const SCENE: &str = "\
[placement]
longest_m = 0.4
[quality]
lod_scale = 0.2
[frames]
count = 20
rate_hz = 20
[[keyframe]]
time_s = 0.0
rotation_deg = [0.0, 0.0, 0.0]
[[keyframe]]
time_s = 1.0
rotation_deg = [0.0, 30.0, 0.0]
";

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    /// Draws the scene over a volume, with more arguments.
    fn simulate(&self, source: &str, more: &[&str]) -> lightloom_tests::program::Ran {
        let (scene, display) = (self.path("scene.toml"), small_display(self.folder.path()));
        fs::write(&scene, scene_of_skins(source, SCENE)).unwrap();
        let out = self.path("out");
        let fixed =
            ["simulate", &scene, "--display", &display, "--device", "cpu", "--backends", "2", "--out", &out];
        run(&mut lightloom(&[&fixed[..], more].concat()))
    }

    /// Records live frames, and gives the traces.
    #[track_caller]
    fn record(&self, source: &str) -> [String; BACKENDS as usize] {
        let traces = self.path("traces");
        self.simulate(source, &["--live", "--fade", "0.1", "--trace", &traces]).succeeded();
        let found = files(Path::new(&traces));
        assert!(found.keys().eq(["backend-0.trace", "backend-1.trace"]), "{:?}", found.keys());
        [0, 1].map(|backend| format!("{traces}/backend-{backend}.trace"))
    }
}

#[track_caller]
fn rows(traces: &[String], more: &[&str]) -> Vec<Value> {
    let fixed: Vec<&str> =
        ["replay", "--json"].into_iter().chain(traces.iter().map(String::as_str)).collect();
    let ran = run(&mut lightloom(&[&fixed[..], more].concat())).succeeded();
    let mut rows: Vec<Value> = serde_json::from_str(&ran.stdout).unwrap();
    for row in &mut rows {
        // The only figure that depends on more than trace and policy.
        let update_ms = row.as_object_mut().unwrap().remove("update_ms").unwrap();
        assert!(update_ms.as_f64().unwrap() >= 0.0);
    }
    rows
}

fn number(row: &Value, name: &str) -> f64 {
    row[name].as_f64().unwrap_or_else(|| panic!("{name} of {row}"))
}

#[test]
fn what_was_recorded_is_replayed_under_every_policy() {
    let bench = Bench::new();
    let traces = bench.record("procedural:shells@256");
    let lists =
        ["--cache-mib", "1,512", "--disk", "50:5,inf:0", "--fade", "0.1", "--order", "deficit,rays,arrival"];
    let rows_found = rows(&traces, &lists);
    assert_eq!(rows_found.len(), 12);
    assert_eq!(rows_found, rows(&traces, &lists), "a replay repeats itself");
    let of = |cache: u64, latency: f64, order: &str| {
        let is_it = |row: &&Value| {
            row["cache_mib"] == cache && row["disk_latency_ms"] == latency && row["order"] == order
        };
        rows_found.iter().find(is_it).unwrap()
    };
    for row in &rows_found {
        assert_eq!(row["frames"], FRAMES * BACKENDS);
        assert!(number(row, "bricks_loaded") > 0.0 && number(row, "mb_read") > 0.0, "{row}");
        assert!(number(row, "mean_deficit") <= number(row, "high_deficit"), "{row}");
        // 16 bricks in a back-end's cache are not enough.
        assert_eq!(
            row["cache_mib"] == 1,
            number(row, "deficit_at_end") > 0.0 && row["seconds_to_rest"].is_null()
        );
    }
    let (best, slow, small) = (of(512, 0.0, "deficit"), of(512, 5.0, "deficit"), of(1, 0.0, "deficit"));
    assert!(number(best, "seconds_to_rest") <= number(slow, "seconds_to_rest"), "{best} {slow}");
    assert!(number(best, "mean_deficit") < number(slow, "mean_deficit"), "{best} {slow}");
    assert!(number(best, "mean_deficit") < number(small, "mean_deficit"), "{best} {small}");
    assert_eq!(best["loaded_again"], 0);
    let table = run(&mut lightloom(&["replay", &traces[0], "--order", "deficit,rays"])).succeeded().stdout;
    assert_eq!(table.lines().count(), 3, "{table}");
}

#[test]
fn a_store_that_has_moved_can_be_given() {
    let bench = Bench::new();
    let import = |size: u32, name: &str| {
        let (input, store) = (format!("procedural:shells@{size}"), bench.path(name));
        run(&mut lightloom(&["import", &input, "-o", &store, "--quiet"])).succeeded();
        store
    };
    let (store, moved, other) =
        (import(64, "here.lloom"), bench.path("there.lloom"), import(40, "other.lloom"));
    let traces = bench.record(&store);
    let here = rows(&traces, &[]);
    fs::rename(&store, &moved).unwrap();
    let replay = |more: &[&str]| run(&mut lightloom(&[&["replay", &traces[0]], more].concat()));
    replay(&[]).refused(&["here.lloom", "--volume"]);
    replay(&["--volume", &other]).refused(&["backend-0.trace", "--volume"]);
    assert_eq!(rows(&traces, &["--volume", &moved]), here);
}

#[test]
fn what_cannot_be_recorded_or_replayed_is_told_in_a_sentence() {
    let bench = Bench::new();
    let traces = bench.path("traces");
    bench.simulate("procedural:shells@32", &["--trace", &traces]).refused(&["--trace", "--live"]);
    assert!(!Path::new(&traces).exists());
    fs::create_dir_all(format!("{traces}/backend-0.trace")).unwrap();
    bench.simulate("procedural:shells@32", &["--live", "--trace", &traces]).refused(&["backend-0.trace"]);
    let (missing, spoilt) = (bench.path("missing.trace"), bench.path("spoilt.trace"));
    fs::write(&spoilt, "{}\n").unwrap();
    run(&mut lightloom(&["replay", &missing])).refused(&["missing.trace"]);
    run(&mut lightloom(&["replay", &spoilt])).refused(&["spoilt.trace", "line 1"]);
}
