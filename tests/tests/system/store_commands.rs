//! What can be asked of an import, and of the store that it made: `import` with its options, `info`, `verify`.

use lightloom_tests::program::{
    Ran, assert_same, files, lightloom, pictures, report, run, scene_of_skins, small_display, start,
    test_data,
};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

/// A scene over data values that asks for the finest level everywhere.
const SCENE: &str = "\
[placement]
longest_m = 0.3
[quality]
lod_scale = 0
";

/// After a signal, an import writes nothing more and takes what it wrote away.
const STOPS_WITHIN: Duration = Duration::from_secs(20);

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

    /// Imports into the folder, and gives what `--json` says.
    #[track_caller]
    fn import(&self, input: &str, name: &str, more: &[&str]) -> Value {
        let store = self.path(name);
        let arguments = [&["import", input, "-o", &store, "--json"], more].concat();
        json_of(&run(&mut lightloom(&arguments)).succeeded())
    }

    /// The scene over a store of the folder.
    fn scene(&self, store: &str) -> String {
        let path = self.path(&format!("{store}.toml"));
        fs::write(&path, scene_of_skins(store, SCENE)).unwrap();
        path
    }

    /// Draws the scene over a store into the folder of this name.
    fn simulate(&self, store: &str, out: &str) -> Ran {
        let (scene, display) = (self.scene(store), small_display(self.folder.path()));
        let out = self.path(out);
        run(&mut lightloom(&["simulate", &scene, "--display", &display, "--device", "cpu", "--out", &out]))
    }

    /// Inverts a part of a file, told in thousandths of it.
    fn spoil(&self, name: &str, from: usize, to: usize) {
        let mut bytes = fs::read(self.path(name)).unwrap();
        let length = bytes.len();
        bytes[length * from / 1000..length * to / 1000].iter_mut().for_each(|byte| *byte = !*byte);
        fs::write(self.path(name), bytes).unwrap();
    }
}

#[track_caller]
fn json_of(ran: &Ran) -> Value {
    serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else")
}

#[test]
fn info_tells_what_an_import_made() {
    let bench = Bench::new();
    let made = bench.import("procedural:shells@100", "a.lloom", &["--bits", "16"]);
    let info = json_of(&run(&mut lightloom(&["info", &bench.path("a.lloom"), "--json"])).succeeded());
    for key in ["dims", "frame", "value_range", "stored_bricks", "level_errors"] {
        assert_eq!(info[key], made[key], "{key}");
    }
    assert_eq!((&info["bits"], &info["codec"]), (&json!(16), &json!("lz4")));
    assert_eq!((&info["nodes"], &info["levels"]), (&json!(64 + 8 + 1), &json!(3)));
    assert_eq!((&info["bytes"], &info["has_deviation"]), (&made["store_bytes"], &json!(true)));
    assert_eq!(info["bytes"], fs::metadata(bench.path("a.lloom")).unwrap().len());
    let plain = bench.import("procedural:shells@100", "plain.lloom", &["--bits", "16", "--no-deviation"]);
    assert!(plain["store_bytes"].as_u64() < made["store_bytes"].as_u64());
    let levels = info["level_errors"].as_array().unwrap();
    assert_eq!(levels.len(), 3);
    let rms = |level: &Value| level["rms_error"].as_f64().unwrap();
    assert!(rms(&levels[0]) < rms(&levels[1]) && rms(&levels[1]) < rms(&levels[2]), "{levels:?}");
}

#[test]
fn info_and_import_read_well() {
    let bench = Bench::new();
    let store = bench.path("a.lloom");
    let made = run(&mut lightloom(&["import", "procedural:shells@100", "-o", &store])).succeeded();
    assert!(made.stdout.contains("100 × 100 × 100 voxels of 1.000 × 1.000 × 1.000 mm"), "{made:?}");
    let ran = run(&mut lightloom(&["info", &store])).succeeded();
    for part in ["100 × 100 × 100", "1.0000 × 1.0000 × 1.0000 mm", "8 bits, codec lz4", "bits per voxel"]
    {
        assert!(ran.stdout.contains(part), "no `{part}` in {}", ran.stdout);
    }
    for (said, lines) in [(&made.stdout, 1), (&ran.stdout, 12)] {
        let table: Vec<_> = said.lines().skip_while(|line| !line.starts_with("level")).collect();
        assert_eq!((said.lines().count(), table.len()), (lines + 4, 4), "{said}");
    }
}

#[test]
fn stores_of_the_first_format_are_told_of() {
    let info = json_of(&run(&mut lightloom(&["info", &test_data("version_1.lloom"), "--json"])).succeeded());
    assert_eq!((&info["format_version"], &info["level_errors"]), (&json!(1), &json!([])));
    run(&mut lightloom(&["verify", &test_data("version_1.lloom")])).succeeded();
}

/// Rows to the left hand, columns to the feet, slices to the back.
#[test]
fn a_patient_keeps_the_orientation() {
    let bench = Bench::new();
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 3 2\n\
                  space directions: (1,0,0) (0,0,-1) (0,2,0)\nspace origin: (5,6,7)\nencoding: raw\n\n";
    let input = bench.path("patient.nrrd");
    fs::write(&input, [header.as_bytes(), &(0..24).collect::<Vec<u8>>()].concat()).unwrap();
    let made = bench.import(&input, "a.lloom", &[]);
    assert_eq!(made["frame"]["orientation"], "x to L, y to I, z to P");
    assert_eq!(made["frame"]["voxel_size_m"], json!([1e-3, 1e-3, 2e-3]));
    let text = run(&mut lightloom(&["info", &bench.path("a.lloom")])).succeeded().stdout;
    assert!(text.contains("x to L, y to I, z to P"), "{text}");
    bench.simulate("a.lloom", "out").succeeded();
    let frame = &report(&bench.folder.path().join("out"))["scene"]["facts"]["frame"];
    assert_eq!(frame["is_orientation_known"], true);
}

#[test]
fn codecs_and_memory_change_no_picture() {
    let bench = Bench::new();
    let import = |name: &str, more: &[&str]| bench.import("procedural:shells@100", name, more);
    let bytes = |made: &Value| made["store_bytes"].as_u64().unwrap();
    let plain = bytes(&import("none.lloom", &["--codec", "none"]));
    let fast = bytes(&import("lz4.lloom", &["--codec", "lz4"]));
    let small = bytes(&import("zstd.lloom", &["--codec", "zstd"]));
    assert!(small < fast && fast < plain, "{small}, {fast}, {plain}");
    import("little.lloom", &["--codec", "lz4", "--memory", "1"]);
    let read = |name: &str| fs::read(bench.path(name)).unwrap();
    assert!(read("little.lloom") == read("lz4.lloom"), "memory must not matter");
    bench.simulate("none.lloom", "out-none").succeeded();
    for (store, out) in [("lz4.lloom", "out-lz4"), ("zstd.lloom", "out-zstd")] {
        bench.simulate(store, out).succeeded();
        let drawn = |out: &str| pictures(&bench.folder.path().join(out));
        assert_same(store, &drawn(out), &drawn("out-none"));
    }
}

#[test]
fn bricks_that_show_nothing_may_be_left_out() {
    let bench = Bench::new();
    let volume = "procedural:shells@200";
    let number = |made: &Value, key: &str| made[key].as_u64().unwrap();
    let whole = bench.import(volume, "whole.lloom", &[]);
    assert_eq!(number(&whole, "emptied_bricks"), 0);
    // The scene names a store that is not there yet.
    let scene = bench.scene("lean.lloom");
    let lean = bench.import(volume, "lean.lloom", &["--empty-for", &scene]);
    let below = bench.import(volume, "below.lloom", &["--empty-below", "0.3"]);
    for made in [&lean, &below] {
        let (left, emptied) = (number(made, "stored_bricks"), number(made, "emptied_bricks"));
        assert!(emptied > 0 && left + emptied == number(&whole, "stored_bricks"), "{made}");
    }
    bench.simulate("whole.lloom", "out-whole").succeeded();
    bench.simulate("lean.lloom", "out-lean").succeeded();
    let drawn = |out: &str| pictures(&bench.folder.path().join(out));
    assert_same("what is not shown is not missed", &drawn("out-lean"), &drawn("out-whole"));
}

#[test]
fn a_look_that_depends_on_the_volume_leaves_nothing_out() {
    let bench = Bench::new();
    let (scene, store) = (bench.path("scene.toml"), bench.path("a.lloom"));
    fs::write(&scene, "[volume]\nsource = 'a.lloom'\n").unwrap();
    let import = ["import", "procedural:shells@16", "-o", &store, "--empty-for"];
    let refused = |scene: &str, parts: &[&str]| {
        run(&mut lightloom(&[&import[..], &[scene]].concat())).refused(parts);
        assert!(!Path::new(&store).exists());
    };
    refused(&scene, &[&scene, "[optics]", "--empty-below"]);
    refused(&bench.path("nowhere.toml"), &[&bench.path("nowhere.toml")]);
}

#[test]
fn a_whole_store_is_said_to_be_whole() {
    let bench = Bench::new();
    let made = bench.import("procedural:shells@64", "a.lloom", &[]);
    let store = bench.path("a.lloom");
    let ran = run(&mut lightloom(&["verify", &store])).succeeded();
    assert!(ran.stdout.starts_with("whole: ") && ran.stdout.lines().count() == 1, "{ran:?}");
    let quiet = run(&mut lightloom(&["verify", &store, "--quiet"])).succeeded();
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    let found = json_of(&run(&mut lightloom(&["verify", &store, "--json"])).succeeded());
    assert_eq!((&found["is_whole"], &found["damages"]), (&json!(true), &json!([])));
    assert_eq!(found["bytes"], made["store_bytes"]);
}

/// One byte anywhere: in the header, the table, a brick.
#[test]
fn a_changed_byte_is_found() {
    let bench = Bench::new();
    bench.import("procedural:shells@64", "a.lloom", &[]);
    let whole = fs::read(bench.path("a.lloom")).unwrap();
    let store = bench.path("spoiled.lloom");
    for part in 0..40 {
        let mut bytes = whole.clone();
        let at = (bytes.len() - 1) * part / 39;
        bytes[at] ^= 0x10;
        fs::write(&store, bytes).unwrap();
        let ran = run(&mut lightloom(&["verify", &store, "--quiet"]));
        ran.refused(&[&store]);
    }
}

#[test]
fn damages_are_listed_and_counted() {
    let bench = Bench::new();
    bench.import("procedural:shells@100", "a.lloom", &["--codec", "none"]);
    bench.spoil("a.lloom", 400, 600);
    let store = bench.path("a.lloom");
    let ran = run(&mut lightloom(&["verify", &store]));
    let damages = ran.stdout.lines().count();
    assert!(damages > 3 && ran.code == Some(1), "{ran:?}");
    let sentence = format!("lightloom: {store} is damaged in {damages} places; copy it again");
    assert!(ran.stderr.contains(&sentence), "{ran:?}");
    let json = run(&mut lightloom(&["verify", &store, "--json"]));
    let found = json_of(&json);
    assert_eq!((&found["is_whole"], &found["damage_count"]), (&json!(false), &json!(damages)));
    assert_eq!(json.code, Some(1));
    run(&mut lightloom(&["verify", &bench.path("none.lloom")])).refused(&["none.lloom"]);
}

/// The picture is drawn from what is left, and everything that tells of it says what is missing.
#[test]
fn a_damaged_brick_does_not_end_a_run() {
    let bench = Bench::new();
    bench.import("procedural:shells@100", "a.lloom", &["--codec", "none"]);
    bench.simulate("a.lloom", "out").succeeded();
    let whole = pictures(&bench.folder.path().join("out"));
    bench.spoil("a.lloom", 400, 600);
    let ran = bench.simulate("a.lloom", "out").succeeded();
    assert!(
        ran.stderr.contains("frame 0 is not complete") && ran.stderr.contains("cannot be read"),
        "{ran:?}"
    );
    let out = bench.folder.path().join("out");
    let report = report(&out);
    let total = &report["total"];
    assert!(total["damaged_bricks"].as_u64() > Some(0) && total["complete"] == json!(false), "{total}");
    let first = total["damaged"][0].as_str().unwrap();
    assert!(first.contains("a.lloom") && first.contains("brick"), "{first}");
    assert!(fs::read_to_string(out.join("report.html")).unwrap().contains("Damaged bricks"));
    let drawn = pictures(&out);
    assert!(drawn.keys().eq(whole.keys()) && drawn != whole);
}

fn signal(name: &str, process: u32) {
    let sent = Command::new("kill").args(["-s", name, &process.to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Starts an import that takes long, and lets it work for a while.
fn long_import(bench: &Bench) -> lightloom_tests::program::Running {
    let store = bench.path("a.lloom");
    let running = start(&mut lightloom(&["import", "procedural:sparse-vessels@1000", "-o", &store]));
    sleep(Duration::from_secs(2));
    running
}

#[test]
fn an_interrupted_import_leaves_nothing() {
    for (name, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let bench = Bench::new();
        let running = long_import(&bench);
        signal(name, running.process());
        let limit = running.age() + STOPS_WITHIN;
        let ran = running.finish(limit);
        assert_eq!(ran.code, Some(code), "{ran:?}");
        ran.refused(&["a.lloom"]);
        assert!(files(bench.folder.path()).is_empty(), "{:?}", files(bench.folder.path()).keys());
    }
}

/// Two signals of two kinds, so that the system does not make one of them.
#[test]
fn who_asks_twice_does_not_wait() {
    let bench = Bench::new();
    let running = long_import(&bench);
    signal("INT", running.process());
    signal("TERM", running.process());
    let limit = running.age() + STOPS_WITHIN;
    let ran = running.finish(limit);
    // The first one may have been quick enough.
    assert!(ran.code.is_none_or(|code| [130, 143].contains(&code)), "{ran:?}");
}
