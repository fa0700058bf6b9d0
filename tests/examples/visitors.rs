//! What visitors' tools do to a head for whoever holds them and for a bystander, and how an exhibit of three visitors goes.
//!
//! `cargo run --release -p lightloom-tests --example visitors -- [pictures | show [SECONDS] | hour [SECONDS]]`
//!
//! Writes `visitors.png` beside its page, or into the present folder.

use image::{RgbImage, imageops};
use lightloom_tests::data;
use lightloom_tests::program::{late_frames, lightloom, run, small_display, start};
use lightloom_tests::results::{self, Program, Results};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Seconds of a show.
const SECONDS: u64 = 120;
/// Seconds of one at full rate.
const HOUR: u64 = 3600;
/// Pixels of a picture on the page.
const SIZE: [u32; 2] = [400, 225];
/// In front of the display, and 20° aside of that.
const EYES: [(&str, &str); 2] = [("holder", "0,0,3"), ("bystander", "1.026,0,2.819")];
/// The tools of the page: what one can be, and what is said of it.
const TOOLS: [(&str, &str); 6] = [
    ("pointer", "points, and changes nothing"),
    ("clip-plane", "cuts the face away; what was cut comes back for who looks from the side"),
    ("probe", "opens a ball to what lies deeper, for who looks along it"),
    ("band-picker", "brings out bone, for who looks along it"),
    ("layer-opacity", "fades the skin, for who looks along it"),
    ("light", "light comes from where it is held, for everybody"),
];

/// The display of the paper with pictures of half the width and less of the height.
const DISPLAY: &str = "\
name = 'holo72 in little'
screen_width_m = 1.60
screen_height_m = 0.90
pixel_size_m = 0.004
angular_accuracy_deg = 0.8
observer_m = [0.0, 0.0, 3.0]
eta = 1.0
[projector_line]
count = 72
from_m = [-3.6, 0.0, -6.0]
to_m = [3.6, 0.0, -6.0]
width_px = 400
height_px = 225
covers = 'screen'
backends = 1
";

/// The head under a veil of skin that hides most of the bone.
const HEAD: &str = "
[placement]
longest_m = 0.75
up = '+z'
front = '+y'
right = '+x'
[optics]
domain = [-1024, 3033]
extinction_unit = 'per_metre'
extinction = [[-1024, 0], [-420, 0], [-250, 60], [-60, 40], [60, 8], [560, 8], [660, 140], [900, 600], [3033, 1500]]
colour = [[-420, 0.80, 0.38, 0.26], [-60, 0.85, 0.42, 0.30], [560, 0.85, 0.60, 0.40], [900, 0.95, 0.88, 0.74], [2200, 1, 0.98, 0.94]]
importance = [[560, 0.0], [700, 1.0]]
[mimda]
gamma = 0.0
[light]
toward = [0.35, 0.6, 0.85]
[[band]]
name = 'bone'
corners = [560, 660, 3033, 3033]
[[band]]
name = 'skin'
corners = [-700, -420, 100, 300]
[tool]
kind = 'pointer'
[[enhancer]]
kind = 'probe'
carried = true
radius_m = 0.2
[[enhancer]]
kind = 'layer-opacity'
carried = true
band = 'skin'
";

/// A wand that is held still: its tip, metres, and its turn about the upright axis as sine and cosine of half of it.
fn wand(tip: [f64; 3], [sin, cos]: [f64; 2]) -> String {
    let pose = format!("{{ sensor = 0, position_m = {tip:?}, orientation = [0.0, {sin:?}, 0.0, {cos:?}] }}");
    let step = |at_s: &str| format!("[[step]]\nat_s = {at_s}\npose = {pose}\n");
    format!("rate_hz = 60\nrepeat = true\n{}{}", step("0.0"), step("1.0"))
}

/// Visitors, each with a wand of one kind that is held still.
struct Cast(Vec<Visitor>);

/// One of them: what they are called, the colour and the kind of their wand, its tip, and its turn as [`wand`] takes it.
struct Visitor(&'static str, &'static str, &'static str, [f64; 3], [f64; 2]);

impl Cast {
    /// Writes an exhibit of the head with these on a tiny display, which suffices for a tape, and its files.
    fn write(&self, folder: &Path, head: &Path) -> Result<String, String> {
        let put =
            |name: &str, text: String| fs::write(folder.join(name), text).map_err(|error| error.to_string());
        put("display.toml", DISPLAY.to_owned())?;
        let tiny = DISPLAY.replace("count = 72", "count = 2").replace("width_px = 400", "width_px = 16");
        put("tiny.toml", tiny.replace("height_px = 225", "height_px = 9"))?;
        put("head.toml", format!("name = 'Head'\n[volume]\nsource = '{}'\n{HEAD}", head.display()))?;
        let (mut exhibit, mut inputs) = (
            "title = 'Head'\ndisplay = 'tiny.toml'\ninputs = 'wands.toml'\n[[item]]\ntitle = 'A head in computed tomography'\nscene = 'head.toml'\n".to_owned(),
            String::new(),
        );
        for &Visitor(name, colour, kind, tip, turn) in &self.0 {
            exhibit += &format!(
                "[[visitor]]\nname = '{name}'\ncolour = '{colour}'\n[[tool]]\nname = 'wand of {name}'\nvisitor = '{name}'\ninput = '{name}'\nkinds = ['{kind}']\n"
            );
            inputs += &format!("[[input]]\nname = '{name}'\nkind = 'script'\npath = '{name}.toml'\n");
            put(&format!("{name}.toml"), wand(tip, turn))?;
        }
        put("wands.toml", inputs)?;
        put("exhibit.toml", exhibit)?;
        Ok(folder.join("exhibit.toml").to_string_lossy().into_owned())
    }

    /// What the eyes see of it.
    fn seen(&self, head: &Path) -> Result<Vec<RgbImage>, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let exhibit = self.write(folder.path(), head)?;
        let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        let (tape, out, display) = (path("day.mcap"), path("out"), path("display.toml"));
        let show = ["exhibit", &exhibit, "--output", "none", "--stepped", "--rate", "10", "--frames", "30"];
        succeed(&[&show[..], &["--record", &tape, "--quiet", "--device", "cpu"]].concat())?;
        let mut draw = vec![
            "simulate",
            &exhibit,
            "--display",
            &display,
            "--tape",
            &tape,
            "--out",
            &out,
            "--quiet",
            "--device",
            "cpu",
        ];
        draw.extend(EYES.iter().flat_map(|(_, at)| ["--eye", at]));
        succeed(&draw)?;
        let eye = |number: usize| {
            let path = Path::new(&out).join(format!("frame-0029/eye-{number}.png"));
            image::open(&path)
                .map(|picture| picture.to_rgb8())
                .map_err(|error| format!("{}: {error}", path.display()))
        };
        (0..EYES.len()).map(eye).collect()
    }
}

fn succeed(arguments: &[&str]) -> Result<String, String> {
    let ran = run(&mut lightloom(arguments));
    if ran.code == Some(0) { Ok(ran.stdout) } else { Err(ran.stderr) }
}

fn pictures() -> Result<(), String> {
    let Some(head) = data::cranium() else { return Err("the cranium CT is not there".to_owned()) };
    let mut results = Results::new(Program::Study("visitors"), "visitors", "pictures");
    results.line("Each row is a tool before the middle of the head, pointing into the screen: as its holder sees it, straight on from 3 m, and as a bystander does, 20° aside.");
    results.line("");
    results.line("| row | tool | |");
    results.line("| --- | --- | --- |");
    let before = [0.0, 0.0, 0.25];
    let mut page = RgbImage::new(2 * SIZE[0], SIZE[1] * (TOOLS.len() as u32 + 1));
    let mut row = |number: usize, seen: Vec<RgbImage>| {
        for (place, picture) in seen.iter().enumerate() {
            imageops::replace(
                &mut page,
                picture,
                (place as u32 * SIZE[0]).into(),
                (number as u32 * SIZE[1]).into(),
            );
        }
    };
    for (number, &(kind, said)) in TOOLS.iter().enumerate() {
        let (tip, turn) = match kind {
            // From the right, so that it shows.
            "light" => ([0.35, 0.1, 0.25], [0.5, 0.866_025_403_784_438_6]),
            "clip-plane" => ([0.0, 0.0, 0.08], [0.0, 1.0]),
            _ => (before, [0.0, 1.0]),
        };
        row(number, Cast(vec![Visitor("Ada", "#ff8a3c", kind, tip, turn)]).seen(head.path())?);
        results.line(format!("| {} | {kind} | {said} |", number + 1));
    }
    let three = Cast(vec![
        Visitor("Ada", "#ff8a3c", "clip-plane", [-0.25, 0.1, 0.1], [-0.5, 0.866_025_403_784_438_6]),
        Visitor("Ben", "#4cc3ff", "probe", [0.15, 0.12, 0.2], [0.0, 1.0]),
        Visitor(
            "Cem",
            "#8be05a",
            "pointer",
            [0.3, -0.15, 0.2],
            [0.382_683_432_365_089_8, 0.923_879_532_511_286_7],
        ),
    ]);
    row(TOOLS.len(), three.seen(head.path())?);
    results.line(format!(
        "| {} | three visitors | a clip plane from the left, a probe and a pointer |",
        TOOLS.len() + 1
    ));
    results.line("");
    results.line("![What each tool does to a head, for its holder and for a bystander](visitors.png)");
    let path = results::folder().unwrap_or_default().join("visitors.png");
    page.save(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    results.finish()
}

/// The folder of the example with three wands.
const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../frontend/exhibit/examples");

/// The same example on a display that is small enough for its rate.
fn at_full_rate(folder: &Path) -> std::io::Result<()> {
    let display = small_display(folder);
    for entry in fs::read_dir(EXAMPLES)? {
        let entry = entry?;
        let text = fs::read_to_string(entry.path())?
            .replace("display = \"desk8\"", &format!("display = '{display}'"));
        fs::write(folder.join(entry.file_name()), text)?;
    }
    Ok(())
}

/// Where a show is, and what is said of it.
enum Stage {
    /// On a desk.
    Desk,
    /// On a display that is small enough for the rate.
    Small,
}

/// The example that ships, driven by the clock.
fn show(seconds: u64, stage: &Stage) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (exhibit, part, display) = match stage {
        Stage::Desk => (format!("{EXAMPLES}/tracked.toml"), "a show", "desk8"),
        Stage::Small => {
            at_full_rate(folder.path()).map_err(|error| error.to_string())?;
            (path("tracked.toml"), "at full rate", "four projectors of 96 × 72 at 60 Hz")
        }
    };
    let (status, tape, length) = (path("status.json"), path("day.mcap"), seconds.to_string());
    let arguments = [
        "exhibit", &exhibit, "--output", "none", "--device", "cpu", "--for", &length, "--status", &status,
        "--record", &tape, "--json",
    ];
    let running = start(&mut lightloom(&arguments));
    let began = Instant::now();
    let read = || -> Option<Value> { serde_json::from_slice(&fs::read(&status).ok()?).ok() };
    let (mut first, mut last) = (None, None);
    while began.elapsed() < Duration::from_secs(seconds) {
        sleep(Duration::from_secs(1));
        last = read().or(last);
        // Once detail has come.
        if began.elapsed() > Duration::from_secs(10.min(seconds / 2)) && first.is_none() {
            first = last.clone();
        }
    }
    let ran = running.finish(Duration::from_secs(seconds + 60));
    let report: Value =
        serde_json::from_str(&ran.stdout).map_err(|error| format!("{error}: {}", ran.stderr))?;
    let (Some(first), Some(last)) = (first, last) else {
        return Err("the exhibit said nothing of itself".to_owned());
    };
    let info: Vec<String> = succeed(&["tape", "info", &tape])?.lines().map(str::to_owned).collect();
    let mut results = Results::new(Program::Study("visitors"), "visitors", part);
    results.line(format!("Three simulated visitors with wands of 60 samples a second, `frontend/exhibit/examples/tracked.toml` on {display}, {seconds} s, no output, tools and names drawn, on tape."));
    results.line("");
    results.line("| | |");
    results.line("| --- | --- |");
    let beat = &report["beat"];
    let frames = &beat["frames"];
    let late = late_frames(beat);
    results.line(format!("| frames shown | {frames} in {seconds} s, {late} of them late |"));
    for (name, key) in [
        ("from input to screen, ms: median, 99 %, largest", "input_to_shown_ms"),
        ("from frame to frame, ms", "interval_ms"),
    ] {
        let value = &beat[key];
        results.line(format!(
            "| {name} | {:.1} / {:.1} / {:.1} |",
            value["p50"].as_f64().unwrap_or(f64::NAN),
            value["p99"].as_f64().unwrap_or(f64::NAN),
            value["max"].as_f64().unwrap_or(f64::NAN)
        ));
    }
    for (name, key) in [
        ("memory of the process, MB, after ten seconds and at the end", "memory_mb"),
        ("open files", "open_files"),
    ] {
        results.line(format!("| {name} | {} → {} |", first[key], last[key]));
    }
    results.line(format!("| the tape | {} |", info.last().cloned().unwrap_or_default()));
    results.finish()
}

fn seconds(text: Option<String>, otherwise: u64) -> Result<u64, String> {
    text.map_or(Ok(otherwise), |text| text.parse()).map_err(|_| "give whole seconds".to_owned())
}

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    match (arguments.next().as_deref(), arguments.next()) {
        (None, None) => pictures().and_then(|()| show(SECONDS, &Stage::Desk)),
        (Some("pictures"), None) => pictures(),
        (Some("show"), length) => show(seconds(length, SECONDS)?, &Stage::Desk),
        (Some("hour"), length) => show(seconds(length, HOUR)?, &Stage::Small),
        _ => Err("give pictures, show, hour, or one of the latter with a number of seconds".to_owned()),
    }
}
