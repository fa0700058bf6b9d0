//! Pictures that take longer than a minute: each was once given up as that of a dead back-end.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example long_pictures
//! ```
//!
//! Takes half an hour on two cores.

use lightloom_tests::phantoms;
use lightloom_tests::program::{self, cluster, lightloom};
use lightloom_tests::results::{Program, Results};
use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Beyond this it hangs.
const LIMIT: Duration = Duration::from_secs(3600);

/// A projector behind a small screen, and what it draws.
struct Case {
    size: [u32; 2],
    scene: &'static str,
    what: &'static str,
    arguments: &'static [&'static str],
    by_mpirun: bool,
}

const CASES: [Case; 8] = [
    case([3840, 2160], "ct.toml", "default look, default quality", &["--device", "cpu"]),
    case([3840, 2160], "ct.toml", "default look, fine", &["--device", "cpu", "--quality", "fine"]),
    case([1920, 1080], "ct.toml", "default look, default quality", &["--device", "gpu"]),
    case([800, 600], "bent.toml", "refraction 1 to 1.2, unsharp", &["--device", "gpu"]),
    case([800, 600], "bent.toml", "the same, fine", &["--device", "cpu", "--quality", "fine"]),
    case([6000, 6000], "shells.toml", "shells of 256³, fine", &["--device", "cpu", "--quality", "fine"]),
    Case {
        by_mpirun: true,
        ..case([6000, 6000], "shells.toml", "the same", &["--device", "cpu", "--quality", "fine"])
    },
    case([160, 120], "short.toml", "steps of 0.0003 voxels", &["--device", "cpu"]),
];

const fn case(
    size: [u32; 2],
    scene: &'static str,
    what: &'static str,
    arguments: &'static [&'static str],
) -> Case {
    Case { size, scene, what, arguments, by_mpirun: false }
}

fn main() -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    write_scenes(folder.path())?;
    let mut results = Results::new(Program::Study("long_pictures"), "long_pictures", "pictures");
    results.line("| projector | chest CT, or what is named | program | seconds | exit code |");
    results.line("| --- | --- | --- | ---: | ---: |");
    let mut worst = None;
    for Case { size: [width, height], scene, what, arguments, by_mpirun } in CASES {
        let (scene, display, out) = (at(scene), at("display.toml"), at("out"));
        write(&display, &display_of([width, height]))?;
        let asked = ["simulate", &scene, "--display", &display, "--out", &out];
        let asked = [&asked, arguments].concat();
        let started = Instant::now();
        let Some(mut command) = (if by_mpirun { cluster(&asked, 1) } else { Some(lightloom(&asked)) }) else {
            continue;
        };
        let ran = program::start(&mut command).finish(LIMIT);
        let seconds = started.elapsed().as_secs_f64();
        let code = ran.code.map_or("none".to_owned(), |code| code.to_string());
        let program = if by_mpirun { "`mpirun`" } else { "one process" };
        results.line(format!(
            "| {width} × {height} | {what}, {} | {program} | {seconds:.0} | {code} |",
            arguments[1]
        ));
        if ran.code != Some(0) {
            worst = Some(ran.stderr);
        }
    }
    results.finish()?;
    worst.map_or(Ok(()), Err)
}

/// A chest as it comes, with bent light and sharpened, and in very short steps; shells.
fn write_scenes(folder: &Path) -> Result<(), String> {
    let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let phantom = phantoms::chest();
    let raw = phantom.write_raw(folder).to_string_lossy().into_owned();
    let mut import = ["import", &raw, "-o", &at("ct.lloom")].map(str::to_owned).to_vec();
    import.extend(phantoms::layout_arguments(phantom.dims, phantom.spacing_mm));
    run(&mut lightloom(&import))?;
    let plain = "[volume]\nsource = \"ct.lloom\"\n[placement]\nlongest_m = 0.4\n";
    write(&at("ct.toml"), plain)?;
    write(&at("short.toml"), &format!("{plain}[quality]\nstep_voxels = 0.0003\ntolerance = 1.0\n"))?;
    write(&at("shells.toml"), "[volume]\nsource = \"procedural:shells\"\nsize = 256\n")?;
    write(&at("display.toml"), &display_of([8, 8]))?;
    let (saved, display) = (at("saved.toml"), at("display.toml"));
    let save =
        ["simulate", &at("ct.toml"), "--display", &display, "--out", &at("first"), "--save-scene", &saved];
    run(&mut lightloom(&save))?;
    let scene = std::fs::read_to_string(&saved).map_err(|error| error.to_string())?;
    let mut bent = String::new();
    for line in scene.lines() {
        let _ = writeln!(bent, "{line}");
        match line {
            "[light]" => bent += "detail = \"unsharp\"\n",
            "[optics]" => bent += "refraction = [[-600.0, 1.0], [3071.0, 1.2]]\n",
            _ => {}
        }
    }
    write(&at("bent.toml"), &bent)
}

fn display_of([width, height]: [u32; 2]) -> String {
    format!(
        "name = \"one\"\nscreen_width_m = 0.4\nscreen_height_m = 0.3\npixel_size_m = 0.0001\nangular_accuracy_deg = 0.01\n\
         observer_m = [0, 0, 1]\neta = 0\n[projector_line]\ncount = 1\nfrom_m = [0, 0, -1]\nto_m = [0, 0, -1]\n\
         width_px = {width}\nheight_px = {height}\ncovers = \"screen\"\nbackends = 1\n"
    )
}

fn write(path: &str, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{path}: {error}"))
}

fn run(command: &mut Command) -> Result<(), String> {
    let ran = program::run(command);
    if ran.code == Some(0) { Ok(()) } else { Err(ran.stderr) }
}
