//! A display whose frames are controlled by error: the same pictures whoever draws them, complete at rest, and idle then.

use lightloom_tests::machine;
use lightloom_tests::program::{
    LIMIT, Pictures, assert_same, cluster, has_gpu, lightloom, pictures, run, small_display, start,
};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// It turns and moves for a quarter of a second, and rests for another.
const MOVING: &str = "\
[volume]
source = 'procedural:shells@64'

[frames]
count = 30
rate_hz = 60

[[keyframe]]
time_s = 0.0
centre_m = [0.05, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 0.0]

[[keyframe]]
time_s = 0.25
centre_m = [0.0, 0.02, 0.0]
rotation_deg = [5.0, 90.0, 0.0]
";
const STILL: &str = "[volume]\nsource = 'procedural:shells@64'\n";
/// Ticks of a second by which Linux counts the time of a process.
const TICKS_PER_S: u64 = 100;

struct Stage(tempfile::TempDir);

impl Stage {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    fn scene(&self, text: &str) -> String {
        fs::write(self.path("scene.toml"), text).unwrap();
        self.path("scene.toml")
    }

    fn display(&self) -> String {
        small_display(self.0.path())
    }

    /// The pictures of the last of some frames that were shown, and how many were.
    fn last(&self, shown: &Pictures) -> (Pictures, usize) {
        let frames: std::collections::BTreeSet<&str> =
            shown.keys().filter_map(|name| name.split_once('/').map(|parts| parts.0)).collect();
        let last = frames.last().map(|frame| format!("{frame}/")).unwrap_or_default();
        let of_last = shown.iter().filter_map(|(name, bytes)| Some((name.strip_prefix(&last)?, bytes)));
        (of_last.map(|(name, bytes)| (name.to_owned(), bytes.clone())).collect(), frames.len())
    }

    /// A frame of a scene, complete.
    fn complete(&self, scene: &str, frame: u32, more: &[&str]) -> Pictures {
        let (out, frames) = (self.path("complete"), format!("{frame}..{}", frame + 1));
        let fixed = ["simulate", scene, "--display", &self.display(), "--out", &out, "--quiet"];
        run(&mut lightloom(&[&fixed[..], &["--frames", &frames], more].concat())).succeeded();
        let folder = Path::new(&out).join(format!("frame-{frame:04}"));
        pictures(&folder).into_iter().filter(|(name, _)| name.starts_with("projector")).collect()
    }
}

/// One, two and four back-ends, in threads and as processes, decide the same and show the same; what rests is complete.
fn agrees(device: &[&str]) {
    let stage = Stage::new();
    let (scene, display) = (stage.scene(MOVING), stage.display());
    let arguments = |name: &str, more: &[&str]| -> Vec<String> {
        let fixed = ["drive", &scene, "--display", &display, "--output", "none", "--stepped", "--quiet"];
        let dump = ["--control".to_owned(), "errors".to_owned(), "--dump".to_owned(), stage.path(name)];
        fixed.iter().chain(device).chain(more).map(|&word| word.to_owned()).chain(dump).collect()
    };
    let shown = |name: &str, more: &[&str]| {
        run(&mut lightloom(&arguments(name, more))).succeeded();
        pictures(Path::new(&stage.path(name)))
    };
    let one = shown("one", &[]);
    assert_same("2 back-ends", &one, &shown("two", &["--backends", "2"]));
    assert_same("4 back-ends", &one, &shown("four", &["--backends", "4"]));
    if let Some(mut command) = cluster(&arguments("ranks", &[]), 4) {
        start(&mut command).finish(LIMIT).succeeded();
        assert_same("4 processes", &one, &pictures(Path::new(&stage.path("ranks"))));
    }
    let (last, frames) = stage.last(&one);
    assert!(frames >= 8, "{frames} frames were shown of what moves");
    let complete = stage.complete(&scene, 29, device);
    assert_same("what rests", &complete, &last);
    let full = stage.complete(&scene, 5, device);
    let shows_full =
        |frame: &str| full.iter().all(|(name, bytes)| one.get(&format!("{frame}/{name}")) == Some(bytes));
    let whole =
        one.keys().filter_map(|name| name.split_once('/')).filter(|(frame, _)| shows_full(frame)).count();
    assert_eq!(whole, 0, "the canary: what moves is not complete");
}

#[test]
fn rays_are_controlled_alike_whoever_casts_them() {
    agrees(&["--device", "cpu", "--caster", "rays"]);
}

#[test]
fn row_planes_are_controlled_alike_whoever_casts_them() {
    agrees(&["--device", "cpu", "--caster", "planes"]);
}

#[test]
fn a_gpu_is_controlled_alike_whoever_has_it() {
    if has_gpu() {
        agrees(&["--device", "gpu"]);
    }
}

/// The time that a process has used of the cores, in ticks.
fn used(process: u32) -> u64 {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
}

/// Whether the last frame of a dump that is being written has these pictures.
fn shows_last(dump: &str, wanted: &Pictures) -> bool {
    let frames = fs::read_dir(dump).into_iter().flatten().flatten();
    let Some(last) = frames.map(|frame| frame.path()).max() else { return false };
    wanted.iter().all(|(name, bytes)| fs::read(last.join(name)).is_ok_and(|found| found == *bytes))
}

#[test]
fn what_rests_is_complete_and_takes_no_core() {
    machine::alone();
    for caster in ["rays", "planes"] {
        let stage = Stage::new();
        let (scene, display, dump) = (stage.scene(STILL), stage.display(), stage.path("dump"));
        let arguments = [
            "drive",
            &scene,
            "--display",
            &display,
            "--device",
            "cpu",
            "--caster",
            caster,
            "--output",
            "none",
            "--control",
            "errors",
            "--dump",
            &dump,
            "--json",
        ];
        let complete = stage.complete(&scene, 0, &["--device", "cpu", "--caster", caster]);
        let running = start(&mut lightloom(&arguments));
        machine::wait_for("the complete pictures", || shows_last(&dump, &complete));
        // What is shown last is noted, and then nothing is left to do.
        sleep(Duration::from_secs(1));
        let before = used(running.process());
        sleep(Duration::from_secs(2));
        let busy = used(running.process()) - before;
        // A twentieth of a core: the front-end asks its inputs sixty times a second.
        assert!(busy <= 2 * TICKS_PER_S / 20, "{caster}: {busy} hundredths of a second in two");
        // As long again as all before, so that it was idle for most of the time.
        sleep(running.age());
        running.interrupt();
        let ran = running.finish(LIMIT).succeeded();
        let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
        assert!(report["control"]["idle_share"].as_f64().unwrap() > 0.4, "{report}");
        assert!(report["control"]["shown_complete"].as_u64().unwrap() > 0, "{report}");
        let (last, _) = stage.last(&pictures(Path::new(&dump)));
        assert_same(caster, &complete, &last);
    }
}

#[test]
fn fixed_rules_keep_their_targets() {
    let stage = Stage::new();
    let (scene, display) = (stage.scene(MOVING), stage.display());
    let shown = |rule: &str, name: &str| {
        let dump = stage.path(name);
        let arguments = [
            "drive",
            &scene,
            "--display",
            &display,
            "--device",
            "cpu",
            "--output",
            "none",
            "--stepped",
            "--control",
            rule,
            "--dump",
            &dump,
            "--json",
        ];
        let ran = run(&mut lightloom(&arguments)).succeeded();
        let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
        (report["control"].clone(), pictures(Path::new(&dump)))
    };
    let (half, _) = shown("quality=0.5", "half");
    assert!(half["mean_share"].as_f64().unwrap() >= 0.5, "{half}");
    let (whole, frames) = shown("quality=1", "whole");
    // Whatever comes first is shown.
    assert_eq!(
        whole["shown"].as_u64(),
        whole["shown_complete"].as_u64().map(|complete| complete + 1),
        "{whole}"
    );
    assert_same("what rests", &stage.complete(&scene, 29, &["--device", "cpu"]), &stage.last(&frames).0);
    // Time stands still while a picture is cast: it is complete before its time is up.
    let (timed, _) = shown("rate=20", "timed");
    assert_eq!(
        timed["shown"].as_u64(),
        timed["shown_complete"].as_u64().map(|complete| complete + 1),
        "{timed}"
    );
}

#[test]
fn what_is_no_rule_is_refused() {
    for wrong in ["fast", "rate=0", "quality=2", "errors=0.5"] {
        let arguments = ["drive", "procedural:shells@16", "--output", "none", "--control", wrong];
        run(&mut lightloom(&arguments)).refused(&["--control", "rate=HZ", "quality=SHARE"]);
    }
}

#[test]
fn the_best_rule_is_found_and_shown_on_a_page() {
    let stage = Stage::new();
    let (scene, out, display) = (stage.scene(STILL), stage.path("tuned"), stage.display());
    let arguments =
        ["tune", &scene, "-o", &out, "--display", &display, "--size", "32x24", "--machines", "0.2", "--json"];
    let ran = run(&mut lightloom(&arguments)).succeeded();
    let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
    assert_eq!(report["scenarios"].as_array().unwrap().len(), 3);
    let stages = report["stages"].as_array().unwrap();
    assert_eq!(stages.len(), 3);
    for stage in stages {
        let best = &stage["settings"][stage["best"].as_u64().unwrap() as usize];
        let badness = |setting: &Value| setting["badness"].as_f64().unwrap();
        let numbered = stage["settings"].as_array().unwrap().iter().filter(|one| !one["value"].is_null());
        assert!(numbered.clone().all(|one| badness(best) <= badness(one)), "{stage}");
    }
    let page = fs::read_to_string(Path::new(&out).join("tune.html")).unwrap();
    assert!(
        page.matches("<svg").count() >= 7
            && page.contains("Worst instants")
            && page.contains("data:image/png")
    );
    let missing = ["tune", "nowhere.toml", "-o", &out];
    run(&mut lightloom(&missing)).refused(&["nowhere.toml"]);
}
