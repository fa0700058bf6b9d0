//! What pictures cost a core, by row planes and ray by ray: instructions, loads and stores, and misses of its caches as Valgrind
//! counts them, beside the time; prints tables in Markdown.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example cost
//! ```
//!
//! The head is drawn on some rows of `holo72` by one thread, in two runs of which one draws more frames: the difference is what complete
//! frames cost whose bricks are all there. Valgrind has to be installed. `--draw STORE SCENE CASTER VIEWS FRAMES` is what it runs.

use bricks::BrickSource;
use bricks::store::Store;
use display_config::Display;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::{draw, scanned_head};
use protocol::{CasterChoice, DeviceChoice, FrameState};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

/// Rows that are drawn, spread over the screen.
const ROWS: u32 = 8;
const COLUMNS: u32 = 800;
/// A core's own caches, as they are simulated: bytes, ways, bytes of a line.
const CACHES: [&str; 3] = ["--I1=32768,8,64", "--D1=32768,8,64", "--LL=1048576,16,64"];
/// Frames that are timed; the fastest counts, as whatever else a machine does only adds.
const TIMED: usize = 5;
/// Views whose sharing of planes is told from what each of them adds.
const VIEWS: [u32; 2] = [72, 24];
/// Views that are drawn ray by ray, and how often, so that as many rays are counted as by planes.
const RAY_VIEWS: u32 = 3;
const RAY_FRAMES: usize = 24;

/// What was counted, event by event.
#[derive(Clone, Copy, Debug)]
struct Counts {
    instructions: f64,
    accesses: f64,
    misses: f64,
    misses_of_both: f64,
}

impl Counts {
    /// From what Valgrind has written.
    fn parse(text: &str) -> Option<Self> {
        let line = |name: &str| text.lines().find_map(|line| line.strip_prefix(name));
        let (events, summary) = (line("events: ")?, line("summary: ")?);
        let of = |name: &str| -> Option<f64> {
            let place = events.split_whitespace().position(|event| event == name)?;
            summary.split_whitespace().nth(place)?.parse().ok()
        };
        Some(Self {
            instructions: of("Ir")?,
            accesses: of("Dr")? + of("Dw")?,
            misses: of("D1mr")? + of("D1mw")?,
            misses_of_both: of("DLmr")? + of("DLmw")?,
        })
    }

    fn map_both(self, other: Self, join: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            instructions: join(self.instructions, other.instructions),
            accesses: join(self.accesses, other.accesses),
            misses: join(self.misses, other.misses),
            misses_of_both: join(self.misses_of_both, other.misses_of_both),
        }
    }
}

/// One of the scenes, its store and its caster, for some views.
#[derive(Clone, Copy)]
struct Drawing<'a> {
    store: &'a Path,
    scene: &'a str,
    caster: &'a str,
    views: u32,
}

/// Views of `holo72` evenly spread, and the screen's rows.
fn display() -> Result<Display, String> {
    Ok(Display::load("holo72").map_err(|error| error.to_string())?.with_rasters(COLUMNS, ROWS))
}

impl Drawing<'_> {
    /// Draws so many frames with one thread; the seconds of each.
    fn draw(&self, frames: usize) -> Result<Vec<f64>, String> {
        let display = display()?;
        let head: Arc<dyn BrickSource> =
            Arc::new(Store::open(self.store).map_err(|error| error.to_string())?);
        let scenes = scanned_head::frames(&display, &*head);
        let known = scenes.into_iter().find(|(name, _)| *name == self.scene);
        let mut frame: FrameState = known.ok_or_else(|| format!("`{}` is no scene", self.scene))?.1;
        // As fine as all rows of the display ask for.
        frame.quality.lod_scale = 0.0;
        let caster = if self.caster == "planes" { CasterChoice::Planes } else { CasterChoice::Rays };
        let with = draw::With { cache_bytes: 1 << 30, caster, ..draw::With::device(DeviceChoice::Cpu) };
        let projectors: Vec<u32> = (0..self.views).map(|view| (2 * view + 1) * 36 / self.views).collect();
        let (mut renderer, _) = draw::renderer(&display, &head, &projectors, with);
        Ok((0..frames).map(|_| draw::timed(&mut renderer, &frame, &[]).0).collect())
    }

    /// The same in a process of its own, under Valgrind.
    fn counted(&self, frames: usize) -> Result<Counts, String> {
        let folder = self.store.parent().expect("the store lies in a folder");
        let out = folder.join("counts");
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let output = Command::new("valgrind")
            .args(["--tool=cachegrind", "--cache-sim=yes"])
            .args(CACHES)
            .arg(format!("--cachegrind-out-file={}", out.display()))
            .arg(program)
            .arg("--draw")
            .arg(self.store)
            .args([self.scene, self.caster, &self.views.to_string(), &frames.to_string()])
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .map_err(|error| format!("valgrind does not run: {error}; install it"))?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned());
        }
        let text = std::fs::read_to_string(&out).map_err(|error| format!("{}: {error}", out.display()))?;
        Counts::parse(&text).ok_or_else(|| format!("{} has no summary", out.display()))
    }

    /// What a frame costs whose bricks are all there.
    fn cost(&self) -> Result<Counts, String> {
        let frames = if self.caster == "planes" { 1 } else { RAY_FRAMES };
        let each = |all: f64, first: f64| (all - first) / frames as f64;
        Ok(self.counted(1 + frames)?.map_both(self.counted(1)?, each))
    }

    /// Seconds of such a frame.
    fn seconds(&self) -> Result<f64, String> {
        Ok(self.draw(1 + TIMED)?.into_iter().skip(1).fold(f64::INFINITY, f64::min))
    }

    fn rays(&self) -> f64 {
        f64::from(self.views * COLUMNS * ROWS)
    }
}

/// Of what a frame costs, what all views share.
fn shared(of: impl Fn(u32) -> Result<Counts, String>) -> Result<(Counts, f64), String> {
    let [all, some] = VIEWS.map(of);
    let [many, few] = VIEWS.map(f64::from);
    let all = all?;
    // What each view adds is the same for all.
    let shared = all.map_both(some?, |all, some| all - many * (all - some) / (many - few));
    Ok((all, shared.instructions / all.instructions))
}

/// A row of the table, ray by ray.
fn row(drawing: &Drawing, (cost, shared): (Counts, Option<f64>)) -> Result<String, String> {
    let (seconds, rays) = (drawing.seconds()?, drawing.rays());
    Ok(format!(
        "| {} | {} | {:.0} | {} | {:.0} | {:.1} | {:.2} | {:.0} | {:.1} |",
        drawing.scene,
        drawing.caster,
        cost.instructions / rays,
        shared.map_or("–".to_owned(), |shared| format!("{:.0} %", 100.0 * shared)),
        cost.accesses / rays,
        cost.misses / rays,
        cost.misses_of_both / rays,
        1e9 * seconds / rays,
        cost.instructions / (1e9 * seconds),
    ))
}

fn table() -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    scanned_head::store(folder.path());
    let store = folder.path().join("head.lloom");
    let mut counted = Vec::new();
    for scene in ["head, semi-transparent", "head, opaque", "head, opaque, shaded"] {
        let of = |caster, views| Drawing { store: &store, scene, caster, views };
        let (cost, share) = shared(|views| of("planes", views).cost())?;
        counted.push((of("planes", VIEWS[0]), (cost, Some(share))));
        let rays = of("rays", RAY_VIEWS);
        counted.push((rays, (rays.cost()?, None)));
        eprintln!("{scene} is counted");
    }
    let mut results = Results::new(Program::Study("cost"), "planes", "cost");
    results.line("| scene | caster | instructions a ray | of these shared | loads and stores | misses of 32 KiB | of 1 MiB | ns a ray | instructions a ns |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (drawing, cost) in counted {
        results.line(row(&drawing, cost)?);
    }
    results.finish()
}

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] => {
            // Before any other thread is: one draws, as under Valgrind.
            rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build_global()
                .map_err(|error| error.to_string())?;
            table()
        }
        ["--draw", store, scene, caster, views, frames] => {
            let number = |text: &str| text.parse::<u32>().map_err(|error| format!("`{text}`: {error}"));
            let drawing = Drawing { store: Path::new(store), scene, caster, views: number(views)? };
            drawing.draw(number(frames)? as usize).map(|_| ())
        }
        _ => Err("give nothing, or --draw STORE SCENE CASTER VIEWS FRAMES".to_owned()),
    }
}
