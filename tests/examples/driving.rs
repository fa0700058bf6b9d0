//! How fast and how evenly a display is driven on this machine: the program itself, with its output nowhere.
//!
//! `cargo run --release -p lightloom-tests --example driving -- [--device cpu|gpu] [--seconds N] [--messages]`
//!
//! `--messages` measures nothing but what a frame's message costs.

use lightloom_tests::four_outputs::display_on_outputs;
use lightloom_tests::program::{SMALL_DISPLAY, cluster, late_frames, lightloom, run};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::wayland_desktop::WaylandDesktop;
use lightloom_tests::x_server::XServer;
use serde_json::Value;
use std::process::Command;

/// How long each show lasts.
const SECONDS: u32 = 15;

/// Displays with scenes and options: rates as fast as can be.
const SHOWS: [(&str, &str, &[&str]); 10] = [
    ("desk8", "procedural:shells", &[]),
    ("desk8", "procedural:shells", &["--reconstruct", "off"]),
    ("desk8", "procedural:shells", &["--quality", "draft"]),
    ("desk8", "procedural:shells", &["--quality", "draft", "--reconstruct", "off"]),
    ("desk8", "procedural:shells", &["--quality", "draft", "--caster", "planes"]),
    ("desk8", "procedural:sparse-vessels", &["--quality", "draft"]),
    ("desk8", "procedural:sparse-vessels", &["--quality", "draft", "--reconstruct", "off"]),
    ("holo72", "procedural:shells", &[]),
    ("holo72", "procedural:shells", &["--quality", "draft"]),
    ("holo72", "procedural:shells", &["--quality", "draft", "--reconstruct", "off"]),
];

/// Rates of a show that is little work, for latency and skew.
const RATES_HZ: [&str; 3] = ["10", "30", "60"];

/// Ranks that are told what to draw: those of the latency, and the cluster of the largest display.
const RANKS: [u32; 2] = [4, 36];

fn report(command: &mut Command) -> Result<Value, String> {
    let ran = run(command);
    match ran.code {
        Some(0) => serde_json::from_str(&ran.stdout).map_err(|error| error.to_string()),
        _ => Err(ran.stderr),
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn quantiles(value: &Value) -> String {
    format!("{:.2} / {:.2} / {:.2}", number(&value["p50"]), number(&value["p99"]), number(&value["max"]))
}

fn main() -> Result<(), String> {
    let (mut device, mut seconds, mut only_messages) = ("cpu".to_owned(), SECONDS, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_default();
        match argument.as_str() {
            "--device" => device = value(),
            "--seconds" => seconds = value().parse().map_err(|_| "give a number of seconds")?,
            "--messages" => only_messages = true,
            _ => return Err("give --device cpu or gpu, --seconds N, and --messages".to_owned()),
        }
    }
    if !["cpu", "gpu"].contains(&device.as_str()) {
        return Err("give --device cpu or gpu".to_owned());
    }
    let fixed = ["--device", &device, "--json", "--for", &seconds.to_string()].map(str::to_owned);
    if only_messages {
        return messages(&fixed);
    }
    rates(&device, &fixed)?;
    // What back-ends on one machine keep in step does not depend on what draws.
    if device == "cpu" {
        latency(&fixed)?;
        messages(&fixed)?;
    }
    Ok(())
}

/// Shows as fast as they can be.
fn rates(device: &str, fixed: &[String]) -> Result<(), String> {
    let part = if device == "cpu" { "rates" } else { "rates on a GPU" };
    let mut results = Results::new(Program::Study("driving"), "driving", part);
    results.line("| display | scene | options | rays by | frames a second | from a frame to the next, ms | from input to screen, ms | to draw a frame, ms: all, casting, bringing back |");
    results.line("| --- | --- | --- | --- | ---: | ---: | ---: | ---: |");
    // A GPU draws no row planes yet.
    let shows = SHOWS.iter().filter(|(.., options)| device == "cpu" || !options.contains(&"planes"));
    for (display, scene, options) in shows {
        let words = ["drive", scene, "--display", display, "--output", "none"]
            .into_iter()
            .chain(options.iter().copied());
        let words: Vec<String> = words.map(str::to_owned).chain(fixed.iter().cloned()).collect();
        let report = report(&mut lightloom(&words))?;
        let beat = &report["beat"];
        results.drawn_by(report["backends"][0]["adapter"].as_str().unwrap_or_default());
        let caster =
            report["casters"][0].as_str().unwrap_or_default().split([':', ',']).next().unwrap_or_default();
        let (drawing, spent) = (&beat["backends"][0]["drawing_ms"], &report["stages"][0]);
        let each = |stage: &str| number(&spent[stage]) / number(&drawing["count"]);
        results.line(format!(
            "| {display} | {scene} | `{}` | {caster} | {:.1} | {} | {} | {:.1}, {:.1}, {:.1} |",
            options.join(" "),
            1e3 / number(&beat["interval_ms"]["p50"]),
            quantiles(&beat["interval_ms"]),
            quantiles(&beat["input_to_shown_ms"]),
            number(&drawing["p50"]),
            each("cast_ms"),
            each("readback_ms"),
        ));
    }
    results.finish()
}

/// Four processes that draw little.
fn latency(fixed: &[String]) -> Result<(), String> {
    let mut results = Results::new(Program::Study("driving"), "driving", "latency");
    results.line("| rate asked for | onto | frames | from a frame to the next, ms | from input to screen, ms | skew, ms | late |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let small = lightloom_tests::program::small_display(folder.path());
    let x_folder = folder.path().join("x");
    let wayland_folder = folder.path().join("wayland");
    for folder in [&x_folder, &wayland_folder] {
        std::fs::create_dir(folder).map_err(|error| error.to_string())?;
    }
    let place = |name: String, backend| (backend, format!("name = \"{name}\", x_px = 0, y_px = 0"));
    let on_x = [0, 1, 2, 3].map(|backend| place(format!("DUMMY{backend}"), backend));
    let on_x = display_on_outputs(&x_folder, &on_x);
    let on_wayland = [0, 1, 2, 3].map(|backend| place(format!("HEADLESS-{}", backend + 1), backend));
    let on_wayland = display_on_outputs(&wayland_folder, &on_wayland);
    let server = XServer::four_outputs(folder.path());
    let desktop = WaylandDesktop::four_outputs();
    let nothing: (_, _, _, &dyn Fn(Command) -> Command) = ("nothing", "none", &small, &|command| command);
    let x = |command| server.iter().fold(command, |command, server| server.on(command));
    let wayland = |command| desktop.iter().fold(command, |command, desktop| desktop.on(command));
    let shows = [
        Some(nothing),
        server.as_ref().map(|_| ("four outputs of X", "outputs", &on_x, &x as _)),
        desktop.as_ref().map(|_| ("four outputs of Wayland", "outputs", &on_wayland, &wayland as _)),
    ];
    let shows = shows.into_iter().flatten();
    for ((onto, output, display, on), rate) in shows.flat_map(|s| RATES_HZ.map(|rate| (s, rate))) {
        let words = ["drive", "procedural:shells@16", "--display", display, "--output", output];
        let words = words.into_iter().chain(["--quality", "draft", "--rate", rate]);
        let words: Vec<String> = words.map(str::to_owned).chain(fixed.iter().cloned()).collect();
        let Some(command) = cluster(&words, 4) else { return Ok(()) };
        let report = report(&mut on(command))?;
        let beat = &report["beat"];
        let late = late_frames(beat);
        results.line(format!(
            "| {rate} a second | {onto} | {} | {} | {} | {} | {late} |",
            beat["frames"],
            quantiles(&beat["interval_ms"]),
            quantiles(&beat["input_to_shown_ms"]),
            quantiles(&beat["skew_ms"]),
        ));
    }
    results.finish()
}

/// What it costs to tell ranks what to draw: 72 projectors of hardly any pixels, spread over processes of this machine.
fn messages(fixed: &[String]) -> Result<(), String> {
    let mut results = Results::new(Program::Study("driving"), "driving", "messages");
    results.line("| back-ends | frames | to hand a frame over to all, ms | skew, ms | late |");
    results.line("| ---: | ---: | ---: | ---: | ---: |");
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    for ranks in RANKS {
        let path = folder.path().join(format!("messages{ranks}.toml"));
        let display =
            SMALL_DISPLAY.replace("count = 4", "count = 72").replace("backends = 2", "backends = 36");
        let display =
            display.replace("width_px = 96", "width_px = 16").replace("height_px = 72", "height_px = 12");
        std::fs::write(&path, display).map_err(|error| error.to_string())?;
        let words =
            ["drive", "procedural:shells@16", "--display", &path.to_string_lossy(), "--output", "none"];
        let words = words.into_iter().chain(["--quality", "draft", "--rate", "10"]);
        let words: Vec<String> = words.map(str::to_owned).chain(fixed.iter().cloned()).collect();
        let Some(mut command) = cluster(&words, ranks) else { return Ok(()) };
        let report = report(&mut command)?;
        let beat = &report["beat"];
        results.line(format!(
            "| {ranks} | {} | {} | {} | {} |",
            beat["frames"],
            quantiles(&beat["handing_over_ms"]),
            quantiles(&beat["skew_ms"]),
            late_frames(beat),
        ));
    }
    results.finish()
}
