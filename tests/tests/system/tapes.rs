//! The tapes that come with the program, played by all that plays tapes.

use lightloom_tests::program::{Pictures, assert_same, lightloom, pictures, run, small_display};
use serde_json::Value;
use std::fs;
use std::path::Path;

const TAPES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../frontend/tapes/");
/// Name, frames, and the sources whose events are on it.
const SHIPPED: [(&str, u64, &[&str]); 2] =
    [("handling", 600, &["hand"]), ("cutting", 630, &["hand", "knife"])];

/// Copies of the exhibits on a small display, with a small volume.
struct Copies(tempfile::TempDir);

impl Copies {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        small_display(folder.path());
        for entry in fs::read_dir(TAPES).unwrap().map(|entry| entry.unwrap().path()) {
            let Ok(text) = fs::read_to_string(&entry) else { continue };
            let text = text.replace("\"desk8\"", "\"small4.toml\"").replace("shells@128", "shells@32");
            fs::write(folder.path().join(entry.file_name().unwrap()), text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    /// Plays a tape to the copy of its exhibit; what is told and what is shown.
    fn shown(&self, name: &str, dump: &str, more: &[&str]) -> (Value, Pictures) {
        let (file, dump) = (self.path(&format!("{name}.toml")), self.path(dump));
        let tape = format!("{TAPES}{name}.mcap");
        let fixed = ["exhibit", &file, "--tape", &tape, "--stepped", "--output", "none", "--device", "cpu"];
        let ends = ["--caster", "rays", "--reconstruct", "off", "--json", "--dump", &dump];
        let ran = run(&mut lightloom(&[&fixed[..], &ends, more].concat())).succeeded();
        let report = serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else");
        (report, pictures(Path::new(&dump)))
    }
}

fn json(arguments: &[&str]) -> Value {
    let ran = run(&mut lightloom(arguments)).succeeded();
    serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else")
}

fn of_frame(pictures: &Pictures, frame: u32) -> Pictures {
    let folder = format!("frame-{frame:06}/");
    let of_frame = pictures.iter().filter_map(|(name, bytes)| Some((name.strip_prefix(&folder)?, bytes)));
    of_frame.map(|(name, bytes)| (name.to_owned(), bytes.clone())).collect()
}

/// They are of the first version of tapes, and must go on to play.
#[test]
fn tapes_of_the_first_version_play_to_their_ends() {
    let copies = Copies::new();
    for (name, frames, sources) in SHIPPED {
        let info = json(&["tape", "info", &format!("{TAPES}{name}.mcap"), "--json"]);
        assert_eq!((&info["frames"], &info["ending"]), (&frames.into(), &"whole".into()), "{info}");
        assert!(info["events"].as_object().unwrap().keys().eq(sources), "{info}");
        let (report, shown) = copies.shown(name, name, &[]);
        assert_eq!(report["beat"]["frames"], frames, "{name}");
        let differ =
            (1..frames as u32).filter(|&at| of_frame(&shown, at - 1) != of_frame(&shown, at)).count();
        // Of tools that are drawn nearly all frames differ, but where none is held.
        assert!((100..550).contains(&differ), "{name}: {differ} frames differ from the ones before");
        let (_, again) = copies.shown(name, "again", &["--frames", "120", "--backends", "2"]);
        (0..120).for_each(|frame| {
            let one = of_frame(&shown, frame);
            assert_same(&format!("{name}, frame {frame}"), &one, &of_frame(&again, frame));
        });
    }
}

/// A program that has changed since may say so only of frames that show anything else.
#[test]
fn frames_of_the_first_version_are_what_they_were() {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().to_string_lossy().into_owned();
    for (name, ..) in SHIPPED {
        let [file, tape] = ["toml", "mcap"].map(|kind| format!("{TAPES}{name}.{kind}"));
        let fixed = ["simulate", &file, "--tape", &tape, "--frames", "90..91", "--out", &out, "--quiet"];
        let said = run(&mut lightloom(&[&fixed[..], &["--device", "cpu"]].concat())).succeeded().stderr;
        assert!(!said.contains("is not what it was"), "{name}");
    }
}

#[test]
fn a_frame_of_a_tape_is_simulated_as_it_is_driven() {
    let copies = Copies::new();
    let (_, shown) = copies.shown("cutting", "driven", &["--frames", "121"]);
    let (file, tape, out) = (copies.path("cutting.toml"), format!("{TAPES}cutting.mcap"), copies.path("out"));
    let fixed = ["simulate", &file, "--tape", &tape, "--frames", "120..121", "--out", &out, "--quiet"];
    run(&mut lightloom(&[&fixed[..], &["--device", "cpu", "--caster", "rays"]].concat())).succeeded();
    let mut simulated = pictures(&Path::new(&out).join("frame-0120"));
    simulated.retain(|name, _| name.starts_with("projector"));
    assert_same("frame 120", &of_frame(&shown, 120), &simulated);
}

/// Whoever records one again gets the same events in the same order.
#[test]
fn what_is_recorded_again_is_the_same() {
    let copies = Copies::new();
    let events = |tape: &str| -> Vec<Value> {
        let exported = run(&mut lightloom(&["tape", "export", tape, "--as", "json"])).succeeded().stdout;
        let records = exported.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        records.filter(|record| !record.to_string().contains("\"check\"")).collect()
    };
    let (file, tape) = (copies.path("cutting.toml"), copies.path("again.mcap"));
    let fixed = ["exhibit", &file, "--stepped", "--output", "none", "--device", "cpu", "--quiet"];
    run(&mut lightloom(&[&fixed[..], &["--frames", "90", "--record", &tape]].concat())).succeeded();
    let (shipped, again) = (events(&format!("{TAPES}cutting.mcap")), events(&tape));
    assert!(again.len() > 100, "{} events", again.len());
    assert_eq!(again, shipped[..again.len()]);
}

#[test]
fn weights_are_found_from_the_tapes_that_come_with_the_program() {
    let copies = Copies::new();
    let (out, display) = (copies.path("tuned"), copies.path("small4.toml"));
    let fixed = ["tune", "procedural:shells@32", "-o", &out, "--display", &display, "--size", "24x18"];
    let asked = ["--machines", "0.3", "--tape", "shipped", "--only-tapes", "--json"];
    let report = json(&[&fixed[..], &asked].concat());
    let names = SHIPPED.map(|(name, ..)| format!("procedural:shells@32, {name}"));
    assert_eq!(report["scenarios"], serde_json::json!(names));
    for setting in report["stages"][0]["settings"].as_array().unwrap() {
        let scores = setting["scores"].as_array().unwrap();
        let errs = |score: &Value| score["rms"].as_f64().unwrap() > 0.0;
        assert!(scores.len() == SHIPPED.len() && scores.iter().all(errs), "what moves errs: {setting}");
    }
    assert!(fs::read_to_string(Path::new(&out).join("tune.html")).unwrap().contains("handling"));
    let missing = ["tune", "procedural:shells@32", "-o", &out, "--tape", "nowhere.mcap"];
    run(&mut lightloom(&missing)).refused(&["nowhere.mcap"]);
}
