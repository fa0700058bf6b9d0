//! Live views on a cluster of back-ends: where they come to rest, what they record, and what damaged bricks do to them.

use lightloom_tests::machine;
use lightloom_tests::program::{
    Pictures, Ran, assert_same, cluster, files, has_gpu, lightloom, pictures, report, run, scene_of_skins,
    small_display,
};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Frames of a scene: a view has come to rest long before the last.
const FRAMES: usize = 30;
/// Back-ends with two of the small display's four projectors each.
const BACKENDS: u32 = 2;
/// What a brick takes of `--upload-mib`.
const BRICKS_OF_A_MIB: u64 = 16;

/// A view that rests.
const SCENE: &str = "\
[placement]
centre_m = CENTRE
rotation_deg = [20.0, 40.0, 0.0]
longest_m = LONGEST
[quality]
lod_scale = LOD_SCALE
[frames]
count = 30
rate_hz = 20
";

/// Runs of one scene on the small display.
struct Bench {
    folder: tempfile::TempDir,
    scene: String,
    device: &'static str,
}

/// A run that ended well.
struct Drawn {
    ran: Ran,
    report: Value,
    out: std::path::PathBuf,
}

impl Bench {
    /// A volume in the middle of the screen, whose levels the display resolves differently before and behind it.
    fn in_the_middle(source: &str) -> Self {
        Self::new(source, &[("CENTRE", "[0.0, 0.0, 0.0]"), ("LONGEST", "0.4"), ("LOD_SCALE", "0.2")])
    }

    /// A volume so far to the left and behind the screen that only the projectors of back-end 0 see it.
    fn to_the_left(source: &str) -> Self {
        Self::new(source, &[("CENTRE", "[-0.255, 0.0, -0.4]"), ("LONGEST", "0.05"), ("LOD_SCALE", "0")])
    }

    fn new(source: &str, values: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.toml").to_string_lossy().into_owned();
        let fill = |text: String, value: &(&str, &str)| text.replace(value.0, value.1);
        fs::write(&scene, scene_of_skins(source, &values.iter().fold(SCENE.to_owned(), fill))).unwrap();
        Self { folder, scene, device: "cpu" }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    /// Imports a volume as the store of the scene.
    fn import(&self, input: &str) -> String {
        let store = self.path("a.lloom");
        let codec = ["--codec", "none", "--quiet"];
        run(&mut lightloom(&[&["import", input, "-o", &store], &codec[..]].concat())).succeeded();
        store
    }

    fn arguments(&self, out: &Path, more: &[&str]) -> Vec<String> {
        let (display, out) = (small_display(self.folder.path()), out.to_string_lossy());
        let fixed = ["simulate", &self.scene, "--display", &display, "--device", self.device, "--out", &out];
        let outputs = ["--exr", "--quiet"];
        [&fixed[..], &outputs, more].concat().into_iter().map(str::to_owned).collect()
    }

    /// The last frame alone, complete, in one process.
    fn complete(&self, name: &str) -> Drawn {
        let last = format!("{}..{FRAMES}", FRAMES - 1);
        self.in_one_process(name, &["--frames", &last])
    }

    fn in_one_process(&self, name: &str, more: &[&str]) -> Drawn {
        let out = self.folder.path().join(name);
        let ran = run(&mut lightloom(&self.arguments(&out, more))).succeeded();
        Drawn { ran, report: report(&out), out }
    }

    /// All frames, live, on a cluster.
    fn on_a_cluster(&self, name: &str, more: &[&str]) -> Option<Drawn> {
        let out = self.folder.path().join(name);
        let arguments = self.arguments(&out, &[LIVE, more].concat());
        let ran = run(&mut cluster(&arguments, BACKENDS)?).succeeded();
        let drawn = Drawn { ran, report: report(&out), out };
        assert_eq!(drawn.report["backends"].as_array().unwrap().len(), BACKENDS as usize);
        assert_eq!(drawn.frames().len(), FRAMES);
        for frame in drawn.frames() {
            let is_complete = (0..2).all(|backend| frame["backends"][backend]["complete"] == true);
            assert_eq!(frame["total"]["complete"], is_complete, "{}", frame["total"]);
        }
        Some(drawn)
    }
}

const LIVE: &[&str] = &["--live", "--fade", "0.1"];

impl Drawn {
    fn frames(&self) -> &[Value] {
        self.report["frames"].as_array().unwrap()
    }

    fn last(&self) -> &Value {
        self.frames().last().unwrap()
    }

    /// The pictures of a frame.
    fn pictures(&self, frame: usize) -> Pictures {
        let mut found = pictures(&self.out.join(format!("frame-{frame:04}")));
        // A run of one frame has its contact sheet elsewhere.
        found.retain(|name, _| !name.contains("contact-sheet"));
        // Per projector a PNG and an EXR.
        assert_eq!(found.len(), 2 * 4, "{:?}", found.keys());
        found
    }

    /// The pictures of the last frame, in which nothing may be missing.
    #[track_caller]
    fn at_rest(&self) -> Pictures {
        let total = &self.last()["total"];
        assert_eq!(total["complete"], true, "{total}");
        self.pictures(FRAMES - 1)
    }

    /// The frame in which a back-end was at rest for the first time.
    fn rests_from(&self, backend: usize) -> usize {
        let is_complete = |frame: &Value| frame["backends"][backend]["complete"] == true;
        self.frames().iter().position(is_complete).unwrap()
    }

    /// Which projectors' pictures of a frame show something.
    fn shows(&self, frame: &Value) -> Vec<bool> {
        let is_light = |file: &Value| {
            let picture = image::open(self.out.join(file.as_str().unwrap())).unwrap();
            picture.to_rgb8().iter().any(|&code| code > 60)
        };
        frame["pictures"].as_array().unwrap().iter().map(is_light).collect()
    }
}

/// The canary: as soon as every projector shows something, all pictures are other ones than those at rest.
#[track_caller]
fn assert_on_its_way(live: &Drawn, rest: &Pictures) {
    let early = live.frames().iter().find(|frame| live.shows(frame) == [true; 4]).unwrap();
    assert_eq!(early["total"]["complete"], false, "{}", early["total"]);
    let index = early["index"].as_u64().unwrap() as usize;
    for (name, bytes) in live.pictures(index) {
        assert!(bytes != rest[&name], "{name} of frame {index} is at rest");
    }
}

#[test]
fn a_cluster_comes_to_rest_at_the_complete_pictures() {
    for device in if has_gpu() { &["cpu", "gpu"][..] } else { &["cpu"] } {
        let bench = Bench { device, ..Bench::in_the_middle("procedural:shells@128") };
        let complete = bench.complete("complete");
        let rest = complete.at_rest();
        assert_eq!(complete.shows(complete.last()), [true; 4]);
        assert_same("live in one process", &rest, &bench.in_one_process("one", LIVE).at_rest());
        let Some(live) = bench.on_a_cluster("ranks", &[]) else { return };
        assert_same("live on a cluster", &rest, &live.at_rest());
        assert_on_its_way(&live, &rest);
        println!("{device}: at rest from frames {} and {} on", live.rests_from(0), live.rests_from(1));
    }
}

#[test]
fn each_back_end_records_a_store_that_comes_little_by_little() {
    let bench = Bench::in_the_middle("a.lloom");
    bench.import("procedural:shells@256");
    let (traces, alone) = (bench.path("traces"), bench.path("alone"));
    let few = ["--upload-mib", "1", "--trace"];
    let Some(live) = bench.on_a_cluster("ranks", &[&few[..], &[&traces]].concat()) else { return };
    let rest = live.at_rest();
    assert_same("complete", &rest, &bench.complete("complete").at_rest());
    assert_on_its_way(&live, &rest);
    assert_eq!(live.shows(live.last()), [true; 4]);
    for backend in 0..2 {
        let loaded = live.frames().iter().map(|f| f["backends"][backend]["bricks_loaded"].as_u64().unwrap());
        let (most, all) = (loaded.clone().max().unwrap(), loaded.sum::<u64>());
        assert!(most <= BRICKS_OF_A_MIB && all > 5 * BRICKS_OF_A_MIB, "{most} of {all} bricks at once");
        println!("back-end {backend}: {all} bricks, at rest from frame {} on", live.rests_from(backend));
    }

    bench.in_one_process("threads", &[LIVE, &few, &[&alone, "--backends", "2"]].concat());
    let (recorded, expected) = (files(Path::new(&traces)), files(Path::new(&alone)));
    assert!(recorded.keys().eq(["backend-0.trace", "backend-1.trace"]), "{:?}", recorded.keys());
    let at_rest =
        |trace: &Vec<u8>| String::from_utf8(trace.clone()).unwrap().lines().last().unwrap().to_owned();
    for (name, trace) in &recorded {
        assert!(at_rest(trace) == at_rest(&expected[name]), "{name} asks for something else in the end");
        let ran = run(&mut lightloom(&["replay", "--json", &format!("{traces}/{name}")])).succeeded();
        let rows: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!(rows[0]["frames"], FRAMES, "{rows}");
        assert!(rows[0]["bricks_loaded"].as_u64() > Some(5 * BRICKS_OF_A_MIB), "{rows}");
        assert_eq!(rows[0]["deficit_at_end"], 0.0, "{rows}");
    }
    assert!(at_rest(&recorded["backend-0.trace"]) != at_rest(&recorded["backend-1.trace"]));
}

/// The first to be at rest neither ends the run nor speaks for the other.
#[test]
fn a_back_end_with_nothing_to_do_leaves_the_other_its_time() {
    machine::alone();
    let bench = Bench::to_the_left("procedural:shells@128");
    let complete = bench.complete("complete");
    assert_eq!(complete.shows(complete.last()), [true, true, false, false]);
    let Some(live) = bench.on_a_cluster("ranks", &[]) else { return };
    assert_same("live on a cluster", &complete.at_rest(), &live.at_rest());
    let (busy, idle) = (live.rests_from(0), live.rests_from(1));
    println!("at rest from frames {busy} and {idle} on");
    assert!(idle < busy);
}

/// Inverts a part of a file, told in thousandths of it.
fn spoil(path: &str, from: usize, to: usize) {
    let mut bytes = fs::read(path).unwrap();
    let length = bytes.len();
    bytes[length * from / 1000..length * to / 1000].iter_mut().for_each(|byte| *byte = !*byte);
    fs::write(path, bytes).unwrap();
}

#[test]
fn damaged_bricks_are_named_by_the_back_ends_that_met_them() {
    let benches = [(Bench::in_the_middle("a.lloom"), &[0, 1][..]), (Bench::to_the_left("a.lloom"), &[0])];
    for (bench, who_met) in benches {
        let store = bench.import("procedural:shells@128");
        let whole = bench.complete("whole").at_rest();
        spoil(&store, 400, 600);
        let complete = bench.complete("complete");
        let Some(live) = bench.on_a_cluster("ranks", &[]) else { return };
        let damaged = complete.pictures(FRAMES - 1);
        assert_same("complete over the same damage", &damaged, &live.pictures(FRAMES - 1));
        assert!(damaged != whole, "the damage is not seen");
        assert!(live.shows(live.last()).starts_with(&[true; 2]));
        let told: Vec<usize> = (0..2).filter(|&backend| tells_of_damage(&live, backend, &store)).collect();
        assert_eq!(told, who_met);
        assert_eq!(live.last()["total"]["shortfall"].as_array().unwrap().len(), who_met.len());
        let warning = format!("frame {} is not complete: back-end 0: ", FRAMES - 1);
        assert!(live.ran.stderr.contains(&warning), "{}", live.ran.stderr);
        assert!(fs::read_to_string(live.out.join("report.html")).unwrap().contains("Damaged bricks"));
    }
}

/// Whether a back-end misses bricks in the last frame; where it does, everything that tells of them has to name them.
fn tells_of_damage(live: &Drawn, backend: usize, store: &str) -> bool {
    let Value::Object(last) = &live.last()["backends"][backend] else { panic!("no back-end {backend}") };
    let named: Vec<&str> =
        last["damaged"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    assert_eq!(
        (last["damaged_bricks"] == 0, &last["complete"]),
        (named.is_empty(), &json!(named.is_empty()))
    );
    for sentence in &named {
        assert!(sentence.starts_with("brick ") && sentence.contains(store), "{sentence}");
        assert!(live.last()["total"]["damaged"].as_array().unwrap().contains(&json!(sentence)), "{sentence}");
        // The log of the back-end's own process.
        assert!(
            live.ran.stderr.contains(&format!(" WARN renderer::render::damage: {sentence}")),
            "{sentence}"
        );
    }
    !named.is_empty()
}

/// Nothing is coarser than the root: there is nothing to show in its place.
#[test]
fn a_damaged_root_ends_the_run() {
    let bench = Bench::in_the_middle("a.lloom");
    let store = bench.import("procedural:shells@128");
    // The root's brick lies just before the table, which takes the last three thousandths.
    spoil(&store, 989, 994);
    let out = bench.folder.path().join("out");
    let Some(mut command) = cluster(&bench.arguments(&out, LIVE), BACKENDS) else { return };
    let sentence = ["failed while drawing frame", "brick 0/0,0,0", &store, "is damaged"];
    run(&mut command).refused(&sentence);
    assert!(!out.join("report.json").exists(), "a run that failed reports nothing");
}
