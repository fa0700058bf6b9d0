//! The same pictures byte for byte, whoever draws them: one back-end, several, processes, or the run before.

use lightloom_tests::program::{
    LIMIT, Pictures, assert_same, cluster, has_gpu, lightloom, pictures, report, run, small_display, start,
};
use std::fs;
use std::path::Path;

/// Runs of one scene on one display that ought to look the same.
struct Runs<'a> {
    folder: tempfile::TempDir,
    scene: &'a str,
    display: String,
    device: &'a str,
    filter: &'a str,
}

impl<'a> Runs<'a> {
    fn new(scene: &'a str, display: &str, device: &'a str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { folder, scene, display: display.to_owned(), device, filter: "auto" }
    }

    fn arguments(&self, out: &Path, more: &[&str]) -> Vec<String> {
        let out = out.to_string_lossy().into_owned();
        let fixed = ["simulate", self.scene, "--display", &self.display, "--device", self.device];
        let outputs = [
            "--filter",
            self.filter,
            "--out",
            &out,
            "--exr",
            "--eye",
            "0,0,1.2",
            "--eye",
            "-0.1,0.05,1.4",
            "--quiet",
        ];
        fixed.into_iter().chain(outputs).chain(more.iter().copied()).map(str::to_owned).collect()
    }

    fn in_one_process(&self, name: &str, more: &[&str]) -> Pictures {
        let out = self.folder.path().join(name);
        run(&mut lightloom(&self.arguments(&out, more))).succeeded();
        self.complete(&out)
    }

    fn on_a_cluster(&self, name: &str, backends: u32, more: &[&str]) -> Option<Pictures> {
        let out = self.folder.path().join(name);
        let mut command = cluster(&self.arguments(&out, more), backends)?;
        start(&mut command).finish(LIMIT).succeeded();
        assert_eq!(report(&out)["backends"].as_array().unwrap().len(), backends as usize);
        Some(self.complete(&out))
    }

    /// Incomplete pictures may differ, and would say nothing here.
    fn complete(&self, out: &Path) -> Pictures {
        assert_eq!(report(out)["total"]["complete"], true, "{}", report(out)["total"]);
        pictures(out)
    }

    /// One back-end, three of them, and four processes: the same.
    fn agree(&self) -> Pictures {
        let one = self.in_one_process("one", &[]);
        assert_same("3 back-ends in one process", &one, &self.in_one_process("three", &["--backends", "3"]));
        if let Some(ranks) = self.on_a_cluster("ranks", 4, &[]) {
            assert_same("4 back-ends as processes", &one, &ranks);
        }
        one
    }
}

/// A scene in which the observer, the object and the tool move from frame 0 to frame 1.
const SCRIPTED: &str = "\
[volume]
source = 'procedural:shells@64'

[light]
toward = [0.3, 0.6, 0.9]

[tool]
kind = 'light'

[frames]
count = 2
rate_hz = 1

[[keyframe]]
time_s = 0.0
observer_m = [0.0, 0.0, 1.2]
centre_m = [0.0, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 0.0]
tool_tip_m = [0.0, 0.0, 0.5]
tool_axis = [0.0, 0.0, -1.0]

[[keyframe]]
time_s = 1.0
observer_m = [0.02, 0.05, 1.1]
centre_m = [0.03, 0.0, 0.04]
rotation_deg = [10.0, 50.0, 0.0]
tool_tip_m = [0.2, 0.1, 0.4]
tool_axis = [-1.0, -0.5, -1.0]
";

#[test]
fn however_the_projectors_of_a_desk_are_shared() {
    let pictures = Runs::new("procedural:shells", "desk8", "cpu").agree();
    // Per projector and eye a PNG and an EXR, and the contact sheet.
    assert_eq!(pictures.len(), 2 * (8 + 2) + 1, "{:?}", pictures.keys());
}

/// Slots are given as bricks arrive, so this holds only because a brick's samples do not depend on its slot.
#[test]
fn however_the_projectors_are_shared_on_a_gpu() {
    if has_gpu() {
        let folder = tempfile::tempdir().unwrap();
        let display = small_display(folder.path());
        for filter in ["hardware", "exact"] {
            let runs = Runs { filter, ..Runs::new("procedural:shells@128", &display, "gpu") };
            runs.agree();
        }
    }
}

#[test]
fn however_a_scripted_scene_is_shared() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scripted.toml");
    fs::write(&scene, SCRIPTED).unwrap();
    let scene = scene.to_string_lossy().into_owned();
    let runs = Runs::new(&scene, &small_display(folder.path()), "cpu");
    let both = runs.agree();
    for (name, first) in
        both.iter().filter_map(|(name, bytes)| Some((name.strip_prefix("frame-0000/")?, bytes)))
    {
        assert!(both[&format!("frame-0001/{name}")] != *first, "{name} shows no motion");
    }
}

/// What a frame shows does not depend on the frames before it.
#[test]
fn a_frame_alone_or_after_another() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scripted.toml");
    fs::write(&scene, SCRIPTED).unwrap();
    let scene = scene.to_string_lossy().into_owned();
    let runs = Runs::new(&scene, &small_display(folder.path()), "cpu");
    let second = |mut pictures: Pictures| {
        // A run of one frame has its contact sheet in one place, a run of two in two.
        pictures.retain(|name, _| name.starts_with("frame-0001/") && !name.contains("contact-sheet"));
        pictures
    };
    let both = second(runs.in_one_process("both", &[]));
    assert_same("frame 1 alone", &both, &second(runs.in_one_process("alone", &["--frames", "1..2"])));
}

#[test]
fn run_again() {
    let folder = tempfile::tempdir().unwrap();
    let runs = Runs::new("procedural:sparse-vessels@64", &small_display(folder.path()), "cpu");
    let first = runs.in_one_process("first", &[]);
    assert_same("the same command again", &first, &runs.in_one_process("second", &[]));
    assert_same("into the same folder", &first, &runs.in_one_process("second", &[]));
}

/// A cache that holds next to nothing must end, and either show the same or say that it does not.
#[test]
fn with_a_tiny_cache_or_said_to_be_incomplete() {
    let folder = tempfile::tempdir().unwrap();
    let runs = Runs::new("procedural:shells", "desk8", "cpu");
    let whole = runs.in_one_process("whole", &[]);
    let out = folder.path().join("tiny");
    let ran = run(&mut lightloom(&runs.arguments(&out, &["--cache-mib", "1"]))).succeeded();
    let total = &report(&out)["total"];
    if total["complete"] == true {
        assert_same("with a cache of 1 MiB", &whole, &pictures(&out));
        return;
    }
    let shortfall = total["shortfall"][0].as_str().unwrap();
    assert!(
        shortfall.contains("cache is full") && shortfall.contains("make the cache larger"),
        "{shortfall}"
    );
    assert!(ran.stderr.contains("frame 0 is not complete"), "{}", ran.stderr);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Frame 0 is not complete"), "the page says nothing of it");
    assert!(pictures(&out).keys().eq(whole.keys()));
    assert!(total["bricks_resident"].as_u64().unwrap() <= (1 << 20) / (2 * 32 * 32 * 32), "{total}");
}
