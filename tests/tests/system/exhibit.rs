//! Exhibits as a museum runs them, and their tapes.

use lightloom_tests::program::{
    LIMIT, Pictures, assert_same, cluster, lightloom, pictures, run, small_display, start,
};
use serde_json::{Value, json};
use std::fs;
use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../frontend/exhibit/examples/");

/// Two volumes, each for a second, or two while somebody does things, and two visitors with wands that move by themselves.
const TWO_ITEMS: &str = "\
title = 'Two'
display = 'small4.toml'
inputs = 'wands.toml'
quality = 'draft'

[[item]]
title = 'One'
scene = 'procedural:shells@64'
time_s = 1

[[item]]
title = 'Other'
scene = 'procedural:sparse-vessels@64'
time_s = 1

[[visitor]]
name = 'Ada'

[[visitor]]
name = 'Ben'

[[tool]]
name = 'knife'
visitor = 'Ada'
input = 'first'
kinds = ['clip-plane']

[[tool]]
name = 'finger'
visitor = 'Ben'
input = 'second'
kinds = ['pointer']
";

struct Museum {
    folder: tempfile::TempDir,
    file: String,
}

impl Museum {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        small_display(folder.path());
        let wand = |name: &str, file: &str| {
            format!("[[input]]\nname = '{name}'\nkind = 'script'\npath = '{EXAMPLES}{file}'\n")
        };
        fs::write(folder.path().join("wands.toml"), wand("first", "ada.toml") + &wand("second", "cem.toml"))
            .unwrap();
        let file = folder.path().join("exhibit.toml");
        fs::write(&file, text).unwrap();
        Self { file: file.to_string_lossy().into_owned(), folder }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_string_lossy().into_owned()
    }

    fn arguments(&self, dump: &str, more: &[&str]) -> Vec<String> {
        let fixed = [
            "exhibit",
            &self.file,
            "--output",
            "none",
            "--stepped",
            "--rate",
            "10",
            "--device",
            "cpu",
            "--quiet",
        ];
        let dump = ["--dump".to_owned(), self.path(dump)];
        fixed
            .map(str::to_owned)
            .into_iter()
            .chain(dump)
            .chain(more.iter().map(|&one| one.to_owned()))
            .collect()
    }

    /// What screens showed, frame by frame, and what was said besides.
    fn shown(&self, dump: &str, more: &[&str]) -> (Pictures, String) {
        let ran = run(&mut lightloom(&self.arguments(dump, more))).succeeded();
        (pictures(Path::new(&self.path(dump))), ran.stderr)
    }
}

#[test]
fn the_examples_have_no_fault() {
    for name in ["laptop.toml", "tracked.toml"] {
        let ran = run(&mut lightloom(&["exhibit", &format!("{EXAMPLES}{name}"), "--check"])).succeeded();
        assert_eq!(ran.stdout.trim(), "nothing is wrong with it", "{name}");
    }
}

#[test]
fn a_check_says_all_that_is_wrong_at_once() {
    let text = TWO_ITEMS
        .replace("'small4.toml'", "'desk9'")
        .replace("'procedural:shells@64'", "'procedural:shels@64'")
        .replace("name = 'Ben'", "name = '本'")
        .replace("input = 'second'", "input = 'secnd'");
    let museum = Museum::new(&text);
    let ran = run(&mut lightloom(&["exhibit", &museum.file, "--check", "--json"]));
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    let faults: Value = serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else");
    let said = faults.to_string();
    // What the file says alone is told first.
    assert!(said.contains("secnd"), "{said}");
    let museum =
        Museum::new(&text.replace("'secnd'", "'second'").replace("visitor = 'Ben'", "visitor = '本'"));
    let ran = run(&mut lightloom(&["exhibit", &museum.file, "--check"]));
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    for part in ["desk9", "shels", "there are no letters for \"本\""] {
        assert!(ran.stdout.contains(part), "{part} is missing in: {}", ran.stdout);
    }
    // Nothing opens.
    run(&mut lightloom(&["exhibit", &museum.file, "--output", "none", "--frames", "1"])).refused(&["desk9"]);
}

#[test]
fn tools_lie_in_the_volume_where_they_are_asked_to() {
    let scene = |more: &str| {
        format!(
            "name = 'Ball'\n[volume]\nsource = 'procedural:shells@64'\n[optics]\ndomain = [0, 1]\n\
             extinction_unit = 'per_metre'\nextinction = [[0.2, 0], [0.6, 60]]\ncolour = [[0, 1, 0.3, 0.1]]\n{more}"
        )
    };
    // Long enough for pointers to be in it, and of another colour than they are: white before white is no less white.
    let item = TWO_ITEMS
        .replace("'procedural:shells@64'", "'ball.toml'")
        .replace("time_s = 1", "time_s = 60")
        .replace("'clip-plane'", "'pointer'");
    let combined = Museum::new(&format!("{item}\n[marks]\ndepth_combined = true\n"));
    let ball = combined.path("ball.toml");
    fs::write(&ball, scene("refraction = [[0.2, 1.0], [0.6, 1.2]]\n")).unwrap();
    let ran = run(&mut lightloom(&["exhibit", &combined.file, "--check"]));
    assert!(ran.code == Some(1) && ran.stdout.contains("`depth_combined`"), "{}", ran.stdout);
    fs::write(&ball, scene("")).unwrap();
    let through = Museum::new(&item);
    fs::write(through.path("ball.toml"), scene("")).unwrap();
    let (within, _) = combined.shown("within", &["--frames", "30"]);
    let (over, _) = through.shown("over", &["--frames", "30"]);
    assert_eq!(within.len(), over.len());
    assert!(within != over, "tools shine through a ball");
    let (two, _) = combined.shown("two", &["--frames", "30", "--backends", "2"]);
    assert_same("two back-ends", &within, &two);
}

#[test]
fn a_menu_that_cannot_be_read_whole_is_refused() {
    let presets = "[[item.preset]]\ntitle = '上'\n".to_owned() + &"[[item.preset]]\n".repeat(200);
    let text = TWO_ITEMS.replacen("time_s = 1\n", &format!("time_s = 1\n{presets}"), 1);
    let check = |text: &str| {
        let museum = Museum::new(text);
        run(&mut lightloom(&["exhibit", &museum.file, "--check"]))
    };
    check(&text).succeeded();
    let ran = check(&format!("{text}buttons = {{ 0 = 'menu' }}\n"));
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    for part in ["there are no letters for \"上\"", "the menu of finger has no room"] {
        assert!(ran.stdout.contains(part), "{part} is missing in: {}", ran.stdout);
    }
}

#[test]
fn a_tape_shows_the_same_again_in_one_process_and_in_many() {
    let museum = Museum::new(TWO_ITEMS);
    let tape = museum.path("day.mcap");
    let (first, _) = museum.shown("first", &["--frames", "24", "--record", &tape]);
    assert_eq!(first.len(), 24 * first.keys().filter(|name| name.starts_with("frame-000000")).count());
    let info = run(&mut lightloom(&["tape", "info", &tape])).succeeded().stdout;
    assert!(info.contains("24 frames") && info.contains("it is whole"), "{info}");
    let (again, said) = museum.shown("again", &["--tape", &tape]);
    assert_same("played again", &first, &again);
    assert!(!said.contains("is not what it was"), "{said}");
    if let Some(mut command) = cluster(&museum.arguments("cluster", &["--tape", &tape]), 4) {
        start(&mut command).finish(LIMIT).succeeded();
        assert_same("played by four back-ends", &first, &pictures(Path::new(&museum.path("cluster"))));
    }
    // Without its end it still plays, as far as it goes.
    let bytes = fs::read(&tape).unwrap();
    let cut = museum.path("cut.mcap");
    fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let info = run(&mut lightloom(&["tape", "info", &cut])).stdout;
    assert!(!info.contains("it is whole"), "{info}");
}

#[test]
fn a_frame_of_a_tape_is_simulated_at_the_quality_that_is_asked_for() {
    let museum = Museum::new(TWO_ITEMS);
    let (tape, out) = (museum.path("day.mcap"), museum.path("out"));
    museum.shown("shown", &["--frames", "3", "--record", &tape]);
    let simulate = |more: &[&str]| {
        let fixed =
            ["simulate", &museum.file, "--tape", &tape, "--out", &out, "--device", "cpu", "--caster", "rays"];
        run(&mut lightloom(&[&fixed[..], more].concat()))
    };
    let samples = |more: &[&str]| {
        let ran = simulate(&[&["--json"], more].concat()).succeeded();
        assert!(!ran.stderr.contains("is not what it was"), "{}", ran.stderr);
        let report: Value = serde_json::from_str(&ran.stdout).expect("--json prints JSON and nothing else");
        report["total"]["samples"].as_u64().expect("a number of samples")
    };
    let (own, draft, fine) =
        (samples(&[]), samples(&["--quality", "draft"]), samples(&["--quality", "fine"]));
    assert_eq!(own, draft, "the exhibit's own quality is draft");
    assert!(fine > draft, "{fine} samples at quality fine, {draft} at draft");
    simulate(&["--look", "ct-bone"]).refused(&["--look is for scenes"]);
    simulate(&["--save-scene", &museum.path("saved.toml")]).refused(&["--save-scene is for scenes"]);
}

/// Another volume is shown as it is in a show of its own, with nothing left of the one before.
#[test]
fn a_programme_goes_on_to_other_volumes() {
    let still = TWO_ITEMS.split("[[visitor]]").next().unwrap().replace("inputs = 'wands.toml'\n", "")
        + "[marks]\ncaptions = false\n";
    let (both, _) = Museum::new(&still).shown("both", &["--frames", "25"]);
    let alone = {
        let (before, other) = still.split_once("[[item]]").unwrap();
        let (_, other) = other.split_once("[[item]]").unwrap();
        format!("{before}[[item]]{other}")
    };
    let (alone, _) = Museum::new(&alone).shown("alone", &["--frames", "5"]);
    let frame = |pictures: &Pictures, number: usize| -> Vec<Vec<u8>> {
        let name = format!("frame-{number:06}");
        pictures.iter().filter(|(path, _)| path.starts_with(&name)).map(|(_, bytes)| bytes.clone()).collect()
    };
    assert!(!frame(&both, 24).is_empty());
    assert_eq!(frame(&both, 24), frame(&alone, 4), "the second volume is not what it is alone");
    assert_ne!(frame(&both, 24), frame(&both, 3));
}

#[test]
fn a_supervisor_reads_how_it_goes() {
    let museum = Museum::new(TWO_ITEMS);
    let (status, log) = (museum.path("status.json"), museum.path("day.log"));
    let arguments =
        ["exhibit", &museum.file, "--output", "none", "--device", "cpu", "--status", &status, "--log", &log];
    let running = start(&mut lightloom(&arguments));
    let read = || -> Option<Value> { serde_json::from_slice(&fs::read(&status).ok()?).ok() };
    for _ in 0..200 {
        if read().is_some_and(|status| status["frames"].as_u64() > Some(0)) {
            break;
        }
        sleep(Duration::from_millis(100));
    }
    let now = read().expect("a status file");
    assert!(now["state"] == "open" || now["state"] == "attract", "{now}");
    assert_eq!(now["process"], running.process());
    assert_eq!(now["inputs"].as_array().unwrap().len(), 2, "{now}");
    running.interrupt();
    running.finish(LIMIT).succeeded();
    assert_eq!(read().unwrap()["state"], json!("ended"));
    assert!(fs::read_to_string(&log).unwrap().lines().count() >= 2);
}

#[test]
fn a_service_manager_hears_that_it_begins_goes_on_and_ends() {
    let museum = Museum::new(TWO_ITEMS);
    let path = museum.path("notify");
    let manager = UnixDatagram::bind(&path).unwrap();
    manager.set_read_timeout(Some(LIMIT)).unwrap();
    let next = || {
        let mut bytes = [0; 512];
        let length = manager.recv(&mut bytes).expect("it says something");
        String::from_utf8(bytes[..length].to_vec()).unwrap()
    };
    let arguments = ["exhibit", &museum.file, "--output", "none", "--device", "cpu"];
    let running = start(lightloom(&arguments).env("NOTIFY_SOCKET", &path));
    let first = next();
    assert!(first.lines().any(|line| line == "READY=1"), "{first}");
    let began = Instant::now();
    for _ in 0..2 {
        let said = next();
        assert!(said.contains("WATCHDOG=1") && said.contains("STATUS=") && !said.contains("READY"), "{said}");
    }
    assert!(began.elapsed() > Duration::from_secs(1), "once a second is enough");
    running.interrupt();
    running.finish(LIMIT).succeeded();
    let last = std::iter::from_fn(|| Some(next())).find(|said| said.contains("STOPPING=1"));
    assert!(last.is_some());
}
