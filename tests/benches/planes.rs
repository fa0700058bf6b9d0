//! Row planes against single rays: seconds next to the error at which they were measured.
//!
//! `cargo bench -p lightloom-tests --bench planes`; LIGHTLOOM_BENCH_SCENES="name;name" takes those scenes, LIGHTLOOM_BENCH_RAY_VIEWS=n
//! casts n views ray by ray (0: none), and LIGHTLOOM_BENCH_REPEATS=n draws each n times.

use bricks::BrickSource;
use display_config::Display;
use glam::DQuat;
use lightloom_tests::memory::peak_mib;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::{askew, compare, draw, scanned_head, scenes};
use optics::Light;
use protocol::{CasterChoice, DeviceChoice, FrameState};
use std::sync::Arc;

/// Views whose pictures are compared with the reference.
const COMPARED: [u32; 3] = [6, 35, 60];
/// Every so many pixels of them, along x and y.
const COMPARED_STRIDE: u32 = 12;

/// The calibration of the projectors in scenes that are drawn calibrated, too.
const SEED: u64 = 7;
const CALIBRATED: [&str; 3] = ["head, semi-transparent", "head, opaque, shaded", "shells, shaded"];

struct Scene {
    name: String,
    display: Display,
    source: Arc<dyn BrickSource>,
    frame: FrameState,
}

fn scenes(display: &Display, folder: &std::path::Path) -> Vec<Scene> {
    let head: Arc<dyn BrickSource> = Arc::new(scanned_head::store(folder));
    let place = scenes::placed(&*head, 0.75, DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2));
    let mut all = Vec::new();
    let (semi, opaque) = (scanned_head::semi_transparent(), scanned_head::opaque());
    for (name, optics, light) in [
        ("head, semi-transparent", semi, None),
        ("head, opaque", opaque.clone(), None),
        ("head, opaque, shaded", opaque, Some(Light::default())),
    ] {
        let frame = scenes::frame(display, place, optics, light);
        all.push((name, Arc::clone(&head), frame));
    }
    let shells = scenes::shells(display);
    all.push(("shells, shaded", shells.source, shells.frame));
    if let Some(cranium) = scenes::cranium(display) {
        let plain = FrameState { light: None, ..cranium.frame.clone() };
        all.push(("cranium", Arc::clone(&cranium.source), plain));
        all.push(("cranium, shaded", cranium.source, cranium.frame));
    }
    let calibrated = askew::calibrated(display.clone(), SEED);
    let mut scenes = Vec::new();
    for (name, source, frame) in all {
        let scene = |name: String, display: &Display| {
            let (display, source, frame) = (display.clone(), Arc::clone(&source), frame.clone());
            Scene { name, display, source, frame }
        };
        scenes.push(scene(name.to_owned(), display));
        if CALIBRATED.contains(&name) {
            scenes.push(scene(format!("{name}, calibrated"), &calibrated));
        }
    }
    scenes
}

fn main() -> Result<(), String> {
    let number =
        |name: &str, default: usize| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let ray_views = number("LIGHTLOOM_BENCH_RAY_VIEWS", 3).min(72);
    let repeats = number("LIGHTLOOM_BENCH_REPEATS", 3).max(1);
    let wanted = std::env::var("LIGHTLOOM_BENCH_SCENES").unwrap_or_default();
    let display = Display::load("holo72").expect("a preset");
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let mut results = Results::new(Program::Bench("planes"), "planes", "cpu");
    results.line("| scene | caster | views | seconds | Gsamples | RMS, 99.9 %, largest error of 255 | bricks | peak MiB |");
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for Scene { name, display, source, frame } in scenes(&display, folder.path()) {
        if !wanted.is_empty() && !wanted.split(';').any(|part| name == part) {
            continue;
        }
        let truth = compare::truth(&display, &frame, &source, &COMPARED, COMPARED_STRIDE);
        let all: Vec<u32> = (0..72).collect();
        let few: Vec<u32> = COMPARED
            .into_iter()
            .chain((0..72).step_by(4).filter(|p| !COMPARED.contains(p)))
            .take(ray_views)
            .collect();
        for (caster, projectors) in [(CasterChoice::Planes, &all), (CasterChoice::Rays, &few)] {
            if projectors.is_empty() {
                continue;
            }
            let with = draw::With { cache_bytes: 1 << 30, caster, ..draw::With::device(DeviceChoice::Cpu) };
            let (mut renderer, info) = draw::renderer(&display, &source, projectors, with);
            results.drawn_by(&info.adapter);
            let mut runs: Vec<_> =
                (0..repeats).map(|_| draw::timed(&mut renderer, &frame, &COMPARED)).collect();
            runs.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (seconds, report, images) = runs.swap_remove((runs.len() - 1) / 2);
            let kept: Vec<_> =
                truth.iter().copied().filter(|pixel| projectors.contains(&pixel.projector)).collect();
            let errors = compare::errors(&images, &kept);
            let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|e| 255.0 * e);
            results.line(format!(
                "| {name} | {caster:?} | {} | {seconds:.2} | {:.2} | {rms:.3}, {p999:.2}, {max:.2} | {} | {:.0} |",
                projectors.len(),
                report.samples as f64 / 1e9,
                report.working_set_union,
                peak_mib(),
            ));
        }
    }
    results.finish()
}
