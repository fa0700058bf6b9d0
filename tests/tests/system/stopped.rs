//! Runs that somebody stops: what is there by then is whole and has its name, and nothing else is left.

use lightloom_tests::machine;
use lightloom_tests::program::{
    Ran, Running, cluster, files, lightloom, run, scene_of_skins, small_display, start,
};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// From a signal to the end.
const STOPS_WITHIN: Duration = Duration::from_secs(20);
/// Opening and drawing the first frames takes no longer.
const DRAWS_WITHIN: Duration = Duration::from_secs(60);

/// As many frames as there can be.
const ENDLESS: &str = "[frames]\ncount = 4294967295\nrate_hz = 20\n";

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

    /// Starts an endless run, and waits until it has drawn a few frames.
    fn draw(&self, more: &[&str]) -> Running {
        let running = start(&mut lightloom(&self.arguments(more)));
        await_file(&running, &self.folder.path().join("out/frame-0003"));
        running
    }

    fn arguments(&self, more: &[&str]) -> Vec<String> {
        let (scene, display, out) =
            (self.path("scene.toml"), small_display(self.folder.path()), self.path("out"));
        fs::write(&scene, scene_of_skins("procedural:shells@64", ENDLESS)).unwrap();
        let fixed = ["simulate", &scene, "--display", &display, "--device", "cpu", "--out", &out];
        [&fixed[..], more].concat().into_iter().map(str::to_owned).collect()
    }

    /// Nothing in the folder has the name of a working file.
    #[track_caller]
    fn has_no_parts(&self) {
        let parts: Vec<_> =
            files(self.folder.path()).into_keys().filter(|name| name.contains(".part")).collect();
        assert!(parts.is_empty(), "{parts:?}");
    }
}

fn await_file(running: &Running, path: &Path) {
    let since = Instant::now();
    while !path.exists() {
        assert!(
            since.elapsed() < DRAWS_WITHIN,
            "process {} has not written {}",
            running.process(),
            path.display()
        );
        sleep(Duration::from_millis(10));
    }
}

fn stop(running: Running, signal: &str) -> Ran {
    let sent = Command::new("kill").args(["-s", signal, &running.process().to_string()]).status().unwrap();
    assert!(sent.success());
    let limit = running.age() + STOPS_WITHIN;
    running.finish(limit)
}

#[test]
fn a_live_run_that_is_stopped_keeps_its_traces() {
    let bench = Bench::new();
    let traces = bench.path("traces");
    fs::create_dir(&traces).unwrap();
    for name in ["backend-0.trace", "backend-7.trace", "mine.txt"] {
        fs::write(Path::new(&traces).join(name), "earlier").unwrap();
    }
    let running = bench.draw(&["--live", "--trace", &traces, "--backends", "2"]);
    assert_eq!(fs::read_to_string(format!("{traces}/backend-0.trace")).unwrap(), "earlier");
    let ran = stop(running, "INT");
    assert_eq!(ran.code, Some(130), "{ran:?}");
    ran.refused(&["stopped", "drawing frame"]);
    assert!(files(Path::new(&traces)).keys().eq(["backend-0.trace", "backend-1.trace", "mine.txt"]));
    bench.has_no_parts();
    for backend in 0..2 {
        let trace = format!("{traces}/backend-{backend}.trace");
        let replayed = run(&mut lightloom(&["replay", &trace, "--json"])).succeeded();
        let rows: serde_json::Value = serde_json::from_str(&replayed.stdout).unwrap();
        assert!(rows[0]["frames"].as_u64().unwrap() >= 3, "{rows}");
    }
}

/// The launcher ends its ranks when somebody stops it, and gives them a second.
#[test]
fn a_live_run_on_a_cluster_that_is_stopped_keeps_its_traces() {
    machine::alone();
    let bench = Bench::new();
    let traces = bench.path("traces");
    let Some(mut command) = cluster(&bench.arguments(&["--live", "--trace", &traces]), 2) else { return };
    let running = start(&mut command);
    await_file(&running, &bench.folder.path().join("out/frame-0003"));
    let ran = stop(running, "INT");
    assert!(ran.code.is_some_and(|code| code != 0), "{ran:?}");
    let found = files(Path::new(&traces));
    assert!(found.keys().eq(["backend-0.trace", "backend-1.trace"]), "{:?}: {ran:?}", found.keys());
    for backend in 0..2 {
        run(&mut lightloom(&["replay", &format!("{traces}/backend-{backend}.trace")])).succeeded();
    }
}

#[test]
fn a_run_that_is_stopped_leaves_whole_pictures_and_the_signal_s_exit_code() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let bench = Bench::new();
        let running = bench.draw(&["--eye", "0,0,1.2"]);
        let ran = stop(running, signal);
        assert_eq!(ran.code, Some(code), "{ran:?}");
        ran.refused(&["stopped"]);
        bench.has_no_parts();
        let written = files(&bench.folder.path().join("out"));
        assert!(!written.contains_key("report.html") && written.contains_key("frame-0000/eye-0.png"));
        for name in written.keys().filter(|name| name.ends_with(".png")) {
            image::open(bench.folder.path().join("out").join(name)).unwrap();
        }
    }
}

#[test]
fn a_gallery_that_is_stopped_leaves_whole_pictures() {
    let bench = Bench::new();
    let out = bench.path("out");
    let arguments = ["gallery", "procedural:shells@64", "-o", &out, "--device", "cpu", "--size", "120x90"];
    let running = start(&mut lightloom(&arguments));
    await_file(&running, &Path::new(&out).join("gradient-shading-off-left.png"));
    let ran = stop(running, "INT");
    assert_eq!(ran.code, Some(130), "{ran:?}");
    bench.has_no_parts();
    assert!(!Path::new(&out).join("gallery.html").exists());
}
