//! Counts the bricks that pictures need, with visibility feedback and without, as figure 11 and section 6 of the light-field
//! paper do; prints tables in Markdown.
//!
//! ```text
//! cargo run --release -p lightloom-tests --example working_set -- [--gpu] [--only SUBJECT]
//! ```
//!
//! Without feedback: the leaves of the ideal cut (the rule of detail, followed wherever it is not empty by the transfer
//! functions) in view of the rays, whether or not something hides them. With: those that rays sampled in a complete frame.
//! A cache also holds what is above the leaves, and the rest of each family of eight: both are counted. The control shows
//! how far the two counts are apart where nothing hides anything: bricks whose bounds promise more than rays find.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::Display;
use glam::{DQuat, UVec3};
use lightloom_tests::data;
use lightloom_tests::draw::{self, With};
use lightloom_tests::ideal_cut::{IdealCut, ideal_cut};
use lightloom_tests::octaves::{Octaves, cloudy};
use lightloom_tests::remembered::Remembered;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::{self, Colours, Points, scaled};
use optics::Optics;
use protocol::{DeviceChoice, FrameReport, FrameState};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use std::time::Instant;

/// The window of figure 11.
const WINDOW: (u32, u32) = (1024, 576);
/// Factors of extinction, by name. With the last nothing hides anything, and nothing is empty that was not before.
const OPACITIES: [(&str, f64); 4] = [
    ("nearly opaque", 1.0),
    ("more transparent", 1.0 / 12.0),
    ("translucent", 1.0 / 60.0),
    ("control", 1e-7),
];
/// Holds every brick of any of these cuts.
const CACHE_BYTES: u64 = 3 << 30;
/// Back-ends on which the raster's effect is shown: the outermost, one between, one in the middle.
const CONVERGED: [usize; 3] = [0, 9, 18];
/// Rasters on the same screen, the last being the display's own.
const RASTERS: [(u32, u32); 3] = [(200, 150), (400, 300), (800, 600)];
/// Of them on holo72, two projectors each.
const BACKENDS: usize = 36;

/// A volume and how it lies before a display.
struct Subject {
    name: &'static str,
    source: Arc<dyn BrickSource>,
    longest_m: f64,
    rotation: DQuat,
    optics: Optics,
}

impl Subject {
    fn frame(&self, display: &Display, factor: f64) -> FrameState {
        let place = scenes::placed(&*self.source, self.longest_m, self.rotation);
        let mut optics = self.optics.clone();
        optics.extinction = scaled(&optics.extinction, factor);
        scenes::frame(display, place, optics, None)
    }
}

/// Bone and skin. Twice the voxels make about one voxel per pixel of a window that the head fills, as in the paper.
fn cranium() -> Option<Subject> {
    let source: Arc<dyn BrickSource> = Arc::new(data::cranium_doubled()?);
    let extinction: Points = vec![(-400.0, 0.0), (-200.0, 0.6), (3000.0, 1.2)];
    let colour: Colours = vec![(-400.0, [0.8, 0.45, 0.3]), (500.0, [0.95, 0.9, 0.8])];
    Some(Subject {
        name: "cranium CT, 512 × 512 × 216",
        source,
        longest_m: 0.85,
        rotation: DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(-FRAC_PI_2),
        optics: scenes::optics((-1024.0, 3071.0), &extinction, &colour),
    })
}

fn procedural(name: &str, edge: u32) -> Arc<dyn BrickSource> {
    let volume = ProceduralVolume::new(name, UVec3::splat(edge), 1e-3).expect("the name is one of ours");
    Arc::new(Remembered::new(Arc::new(volume)))
}

fn shells(edge: u32, longest_m: f64) -> Subject {
    // Of five shells the outermost is too faint; extinction per voxel falls as voxels get smaller.
    let most = 0.2 * 4096.0 / f64::from(edge);
    Subject {
        name: if edge == 4096 { "shells, 4096³" } else { "shells, 2048³" },
        source: procedural("shells", edge),
        longest_m,
        rotation: DQuat::from_rotation_y(0.4),
        optics: scenes::optics(
            (0.0, 1.0),
            &vec![(0.03, 0.0), (0.1, most), (1.0, most)],
            &vec![(0.0, [0.9, 0.35, 0.1]), (1.0, [0.1, 0.6, 0.9])],
        ),
    }
}

fn vessels(edge: u32, longest_m: f64) -> Subject {
    let most = 0.2 * 4096.0 / f64::from(edge);
    Subject {
        name: if edge == 4096 { "vessels, 4096³" } else { "vessels, 2048³" },
        source: procedural("sparse-vessels", edge),
        longest_m,
        rotation: DQuat::from_rotation_y(-0.3) * DQuat::from_rotation_x(-FRAC_PI_2),
        optics: scenes::optics(
            (0.0, 1.0),
            &vec![(0.05, 0.0), (0.2, most), (1.0, most)],
            &vec![(0.0, [0.5, 0.05, 0.05]), (1.0, [1.0, 0.5, 0.3])],
        ),
    }
}

fn octaves(edge: u32, longest_m: f64) -> Subject {
    Subject {
        name: "dense waves, 4096³",
        source: Arc::new(Remembered::new(Arc::new(Octaves::new(edge, 1)))),
        longest_m,
        rotation: DQuat::from_rotation_y(0.4),
        optics: cloudy(edge),
    }
}

/// What a frame needed, and how much of the light its pictures let through.
struct Need {
    report: FrameReport,
    /// Mean opacity of the pixels that show anything.
    opacity: f64,
    adapter: String,
    seconds: f64,
}

/// Draws a frame into an empty cache.
fn need(
    display: &Display,
    frame: &FrameState,
    source: &Arc<dyn BrickSource>,
    projectors: &[u32],
    device: DeviceChoice,
) -> Need {
    let started = Instant::now();
    let with = With { cache_bytes: CACHE_BYTES, ..With::device(device) };
    let drawn = draw::draw(display, frame, source, projectors, with);
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    let opacities = drawn.images.iter().flat_map(|image| image.rgba.chunks_exact(4)).map(|p| f64::from(p[3]));
    let (sum, shown) =
        opacities.filter(|&a| a > 0.0).fold((0.0, 0.0), |(sum, shown), a| (sum + a, shown + 1.0));
    let seconds = started.elapsed().as_secs_f64();
    Need { report: drawn.report, opacity: sum / shown, adapter: drawn.info.adapter, seconds }
}

/// One perspective picture; the detail wanted is one voxel per pixel at any depth.
fn window(holo: &Display) -> Display {
    let mut display = holo.with_rasters(WINDOW.0, WINDOW.1);
    display.projectors = vec![display.projectors[36].clone()];
    display.pixel_size_m = display.width_m / f64::from(WINDOW.0);
    display.angular_accuracy = 0.0;
    display.eta = 0.0;
    display
}

fn row(results: &mut Results, view: &str, subject: &Subject, opacity: &str, ideal: &IdealCut, need: &Need) {
    let (leaves, held) = (ideal.leaves.len() as u64, ideal.held as u64);
    let (seen, resident) = (need.report.working_set_union, need.report.bricks_resident);
    results.line(format!(
        "| {view} | {} | {opacity} ({:.2}) | {leaves} | {seen} | {:.2} | {held} | {resident} | {:.2} |",
        subject.name,
        need.opacity,
        seen as f64 / leaves as f64,
        resident as f64 / held as f64,
    ));
    eprintln!("{view}, {}, {opacity}: {:.1} s", subject.name, need.seconds);
}

/// Figure 11.
fn visibility(holo: &Display, subjects: &[Subject], device: DeviceChoice) -> Result<(), String> {
    let mut results = Results::new(Program::Study("working_set"), "visibility", "bricks");
    results.line(
        "| view | volume | transfer function (mean opacity) | leaves without | with | ratio | held without | with | ratio |",
    );
    results.line("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    results.line("| window 1024 × 576 | the paper's, 4K | almost opaque | 4553 | 1554 | 0.34 | | | |");
    results.line("| window 1024 × 576 | the paper's, 4K | more transparent | 4620 | 3290 | 0.71 | | | |");
    let views =
        [("window 1024 × 576, η = 0", window(holo), 0.0, 0), ("holo72, projector 36", holo.clone(), 1.0, 36)];
    for (view, display, eta, projector) in &views {
        for subject in subjects {
            for (opacity, factor) in OPACITIES {
                let frame = FrameState { eta: *eta, ..subject.frame(display, factor) };
                let ideal = ideal_cut(&*subject.source, display, &frame, &[*projector]);
                let need = need(display, &frame, &subject.source, &[*projector], device);
                results.drawn_by(&need.adapter);
                row(&mut results, view, subject, opacity, &ideal, &need);
            }
        }
    }
    results.finish()
}

/// Section 6: the load of each back-end, with all of them counted at a raster.
fn back_ends(
    holo: &Display,
    subject: &Subject,
    (part, counted): (&'static str, (u32, u32)),
    device: DeviceChoice,
) -> Result<(), String> {
    let mut results = Results::new(Program::Study("working_set"), "visibility", part);
    let wiring = holo.wiring(BACKENDS).expect("holo72 has 72 projectors");
    let shares: Vec<Vec<u32>> = wiring.shares.into_iter().map(|share| share.projectors).collect();
    results.line(format!("{BACKENDS} back-ends of holo72, two projectors each: {}\n", subject.name));
    results.line("Leaves that rays sampled, of a back-end's two views together, by raster:\n");
    results.line(
        "| transfer function | back-end | 200 × 150 | 400 × 300 | 800 × 600 |\n| --- | ---: | ---: | ---: | ---: |",
    );
    for (opacity, factor) in &OPACITIES[..2] {
        for backend in CONVERGED {
            let counts = RASTERS.map(|(width, height)| {
                let display = holo.with_rasters(width, height);
                let frame = subject.frame(&display, *factor);
                need(&display, &frame, &subject.source, &shares[backend], device).report.working_set_union
            });
            results
                .line(format!("| {opacity} | {backend} | {} | {} | {} |", counts[0], counts[1], counts[2]));
        }
    }
    results.line(format!("\nAll back-ends, at {} × {}:\n", counted.0, counted.1));
    results.line(
        "| transfer function | leaves, mean | largest | largest / mean | union / sum of the two views | held, mean | largest | ideal cut, mean |",
    );
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    results.line("| the paper's | 1549 | 2087 | 1.35 | | | | |");
    let display = holo.with_rasters(counted.0, counted.1);
    for (opacity, factor) in &OPACITIES[..2] {
        let frame = subject.frame(&display, *factor);
        let needs: Vec<(FrameReport, usize)> = shares
            .iter()
            .map(|share| {
                let ideal = ideal_cut(&*subject.source, &display, &frame, share).leaves.len();
                (need(&display, &frame, &subject.source, share, device).report, ideal)
            })
            .collect();
        let of = |count: &dyn Fn(&(FrameReport, usize)) -> u64| -> (f64, u64) {
            let counts: Vec<u64> = needs.iter().map(count).collect();
            let mean = counts.iter().sum::<u64>() as f64 / counts.len() as f64;
            (mean, counts.into_iter().max().unwrap_or(0))
        };
        let (mean, largest) = of(&|n| n.0.working_set_union);
        let (held, most_held) = of(&|n| n.0.bricks_resident);
        let (sum, _) = of(&|n| n.0.working_set_sum.expect("a complete frame counts its views"));
        let (ideal, _) = of(&|n| n.1 as u64);
        results.line(format!(
            "| {opacity} | {mean:.0} | {largest} | {:.2} | {:.2} | {held:.0} | {most_held} | {ideal:.0} |",
            largest as f64 / mean,
            mean / sum,
        ));
        let sizes: BTreeMap<u32, u64> =
            needs.iter().map(|n| (n.0.projectors[0] / 2, n.0.working_set_union)).collect();
        eprintln!("{opacity}, by back-end: {sizes:?}");
    }
    results.finish()
}

fn arguments() -> Result<(DeviceChoice, String), String> {
    let (mut device, mut only) = (DeviceChoice::Cpu, String::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--gpu" => device = DeviceChoice::Gpu,
            "--only" => only = arguments.next().ok_or("`--only` needs a part of a subject's name")?,
            other => return Err(format!("`{other}` is unknown; give [--gpu] [--only SUBJECT]")),
        }
    }
    Ok((device, only))
}

fn main() -> Result<(), String> {
    let (device, only) = arguments()?;
    let holo = Display::load("holo72").map_err(|error| error.to_string())?;
    let subjects: Vec<Subject> =
        [cranium(), Some(shells(4096, holo.height_m)), Some(vessels(4096, holo.height_m))]
            .into_iter()
            .flatten()
            .filter(|subject| subject.name.contains(&only))
            .collect();
    if !subjects.is_empty() {
        visibility(&holo, &subjects, device)?;
    }
    let loads = [
        (shells(2048, holo.height_m), ("back-ends", (400, 300))),
        (octaves(4096, holo.height_m), ("back-ends, dense", (800, 600))),
    ];
    for (subject, what) in loads.into_iter().filter(|(subject, _)| subject.name.contains(&only)) {
        back_ends(&holo, &subject, what, device)?;
    }
    Ok(())
}
