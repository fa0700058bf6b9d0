//! A display that is driven: the same pictures whoever draws them, on screens that keep time.

use lightloom_tests::machine;
use lightloom_tests::program::{
    LIMIT, Pictures, assert_same, cluster, has_gpu, lightloom, pictures, run, small_display, start,
};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// It turns and moves for four frames, and rests for seven.
const MOVING: &str = "\
[volume]
source = 'procedural:shells@64'

[frames]
count = 12
rate_hz = 60

[[keyframe]]
time_s = 0.0
centre_m = [0.05, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 0.0]

[[keyframe]]
time_s = 0.0667
centre_m = [0.0, 0.02, 0.0]
rotation_deg = [5.0, 40.0, 0.0]
";

struct Stage {
    folder: tempfile::TempDir,
    scene: String,
    display: String,
}

impl Stage {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("moving.toml");
        fs::write(&scene, MOVING).unwrap();
        let display = small_display(folder.path());
        Self { scene: scene.to_string_lossy().into_owned(), display, folder }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    fn arguments(&self, dump: &str, more: &[&str]) -> Vec<String> {
        let fixed =
            ["drive", &self.scene, "--display", &self.display, "--output", "none", "--stepped", "--quiet"];
        let dump = ["--dump".to_owned(), self.path(dump)];
        fixed
            .map(str::to_owned)
            .into_iter()
            .chain(dump)
            .chain(more.iter().map(|&one| one.to_owned()))
            .collect()
    }

    /// What screens showed, frame by frame.
    fn driven(&self, name: &str, more: &[&str]) -> Pictures {
        run(&mut lightloom(&self.arguments(name, more))).succeeded();
        pictures(Path::new(&self.path(name)))
    }

    fn driven_on_a_cluster(&self, name: &str, backends: u32, more: &[&str]) -> Option<Pictures> {
        let mut command = cluster(&self.arguments(name, more), backends)?;
        start(&mut command).finish(LIMIT).succeeded();
        Some(pictures(Path::new(&self.path(name))))
    }

    /// What the display shows in the end, drawn as one complete picture a projector.
    fn complete(&self, name: &str, more: &[&str]) -> Pictures {
        let (out, frames) = (self.path(name), ["--frames", "11..12"]);
        let fixed = ["simulate", &self.scene, "--display", &self.display, "--out", &out, "--quiet"];
        run(&mut lightloom(&[&fixed[..], &frames, more].concat())).succeeded();
        let folder = Path::new(&out).join("frame-0011");
        pictures(&folder).into_iter().filter(|(name, _)| name.starts_with("projector")).collect()
    }
}

/// The pictures of one frame, by projector.
fn of_frame(pictures: &Pictures, frame: u32) -> Pictures {
    let folder = format!("frame-{frame:06}/");
    let of =
        |(name, bytes): (&String, &Vec<u8>)| Some((name.strip_prefix(&folder)?.to_owned(), bytes.clone()));
    pictures.iter().filter_map(of).collect()
}

/// One, two and four back-ends, in threads and as processes, show the same; and what rests comes to the complete picture.
fn agrees(device: &[&str]) {
    let stage = Stage::new();
    let with = |more: &[&'static str]| -> Vec<&str> { [device, more].concat() };
    let one = stage.driven("one", device);
    assert_eq!(one.len(), 12 * 4, "every frame of every projector");
    assert_same("2 back-ends", &one, &stage.driven("two", &with(&["--backends", "2"])));
    assert_same("4 back-ends", &one, &stage.driven("four", &with(&["--backends", "4"])));
    if let Some(ranks) = stage.driven_on_a_cluster("ranks", 4, device) {
        assert_same("4 processes", &one, &ranks);
    }
    let complete = stage.complete("complete", device);
    // It rests from frame 5 on: the fourth frame of rest is complete, and so is what follows.
    for frame in 8..12 {
        assert_same("what rests", &complete, &of_frame(&one, frame));
    }
    assert_ne!(complete, of_frame(&one, 4), "the canary: what moves is not what rests");
}

#[test]
fn rays_show_the_same_whoever_draws_them() {
    agrees(&["--device", "cpu", "--caster", "rays"]);
}

#[test]
fn row_planes_show_the_same_whoever_draws_them() {
    agrees(&["--device", "cpu", "--caster", "planes"]);
}

#[test]
fn a_gpu_shows_the_same_whoever_draws_them() {
    if has_gpu() {
        agrees(&["--device", "gpu"]);
    }
}

/// The report of a show that ended well.
fn driven(arguments: &[&str]) -> Value {
    let ran = run(&mut lightloom(&[&["drive"], arguments, &["--json"]].concat())).succeeded();
    serde_json::from_str(&ran.stdout).expect("the report is JSON")
}

#[test]
fn a_show_keeps_time_and_reports() {
    machine::alone();
    let stage = Stage::new();
    let out = stage.path("out");
    let fixed = ["procedural:shells@32", "--display", &stage.display, "--device", "cpu", "--output", "none"];
    let report =
        driven(&[&fixed[..], &["--rate", "20", "--for", "2", "--backends", "2", "--out", &out]].concat());
    assert_eq!(report["end"], "planned");
    let frames = report["beat"]["frames"].as_u64().unwrap();
    assert!((10..=42).contains(&frames), "{frames} frames in 2 s at 20 a second");
    // It may be slow here, but it is never fast.
    assert!(report["beat"]["interval_ms"]["p50"].as_f64().unwrap() > 45.0, "{report}");
    assert_eq!(report["beat"]["backends"].as_array().unwrap().len(), 2);
    let page = fs::read_to_string(Path::new(&out).join("drive.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("from input to screen"));
    let of_cluster = ["drive", "procedural:shells@32", "--display", &stage.display, "--device", "cpu"];
    let more = ["--output", "none", "--rate", "20", "--frames", "30", "--json"];
    if let Some(mut command) = cluster(&[&of_cluster[..], &more].concat(), 3) {
        let ran = start(&mut command).finish(LIMIT).succeeded();
        let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
        assert!(report["beat"]["skew_ms"]["count"].as_u64().unwrap() > 10, "{report}");
        assert!(report["beat"]["handing_over_ms"]["count"].as_u64().unwrap() >= 30, "{report}");
    }
}

#[test]
fn a_signal_ends_a_show_well() {
    let stage = Stage::new();
    let out = stage.path("out");
    let arguments = [
        "drive",
        "procedural:shells@32",
        "--display",
        &stage.display,
        "--device",
        "cpu",
        "--output",
        "none",
        "--out",
        &out,
        "--json",
    ];
    let running = start(&mut lightloom(&arguments));
    sleep(Duration::from_secs(2));
    running.interrupt();
    let ran = running.finish(LIMIT).succeeded();
    let report: Value = serde_json::from_str(&ran.stdout).expect("the report is JSON");
    assert_eq!(report["end"], "stopped");
    assert!(Path::new(&out).join("drive.html").is_file());
}

/// A scene whose clip plane a tool carries, and the tool's pose as its own or as a tracker's.
const CARRIED: &str = "\
[volume]
source = 'procedural:shells@64'

[[enhancer]]
kind = 'clip-plane'
carried = true

[tool]
kind = 'pointer'
";

#[test]
fn a_tracked_tool_is_where_its_tracker_has_it() {
    let stage = Stage::new();
    let write = |name: &str, text: &str| {
        fs::write(stage.path(name), text).unwrap();
        stage.path(name)
    };
    // Turned by a half about y the tool points out of the screen: the other half is cut away.
    let tracked = write("tracked.toml", CARRIED);
    let scripted = write("scripted.toml", &format!("{CARRIED}tip_m = [0.02, 0.0, 0.01]\naxis = [0, 0, 1]\n"));
    let still = write("still.toml", CARRIED);
    write(
        "hand.toml",
        "rate_hz = 60\n[[step]]\nat_s = 0.0\n\
         pose = { sensor = 3, position_m = [0.02, 0.0, 0.01], orientation = [0, 1, 0, 0] }\n\
         [[step]]\nat_s = 60.0\n\
         pose = { sensor = 3, position_m = [0.02, 0.0, 0.01], orientation = [0, 1, 0, 0] }\n",
    );
    let inputs = write("inputs.toml", "[[input]]\nname = 'wand'\nkind = 'script'\npath = 'hand.toml'\n");
    let show = |scene: &str, dump: &str, more: &[&str]| {
        let fixed = ["drive", scene, "--display", &stage.display, "--output", "none", "--stepped", "--quiet"];
        let dump_into = stage.path(dump);
        let more = ["--device", "cpu", "--frames", "30", "--dump", &dump_into]
            .into_iter()
            .chain(more.iter().copied());
        let words: Vec<&str> = fixed.into_iter().chain(more).collect();
        run(&mut lightloom(&words)).succeeded();
        pictures(&Path::new(&dump_into).join("frame-000029"))
    };
    let of_tracker = show(&tracked, "of-tracker", &["--inputs", &inputs]);
    assert_same("tracked and scripted", &of_tracker, &show(&scripted, "of-scene", &[]));
    assert_ne!(of_tracker, show(&still, "still", &[]), "a tool at rest looks the same");
}

#[test]
fn what_cannot_be_driven_is_refused() {
    let refused = |more: &[&str], parts: &[&str]| {
        let mut command = lightloom(&[&["drive", "procedural:shells@16"], more].concat());
        run(command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY")).refused(parts);
    };
    refused(&["--desktop"], &["no window can be opened", "--output none"]);
    refused(&["--output", "none", "--rate", "0"], &["--rate", "0.1 to 1000"]);
    refused(&["--output", "none", "--for", "-1"], &["--for", "above 0"]);
    refused(&["--output", "none", "--frames", "0"], &["--frames"]);
    refused(&["--output", "none", "--dump", "/proc/nowhere"], &["/proc/nowhere"]);
    refused(
        &["--output", "none", "--caster", "planes", "--device", "cpu", "--display", "nowhere.toml"],
        &["nowhere"],
    );
}
