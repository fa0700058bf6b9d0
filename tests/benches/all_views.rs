//! All 72 views of holo72, of a CT-like volume: seconds and samples per second, next to the error at which they were measured.
//!
//! `cargo bench -p lightloom-tests --bench all_views`; LIGHTLOOM_BENCH_VIEWS=n takes n views, evenly spread, and
//! LIGHTLOOM_BENCH_DEVICES=cpu,gpu the devices named; LIGHTLOOM_BENCH_DEVICES=memory measures what views cost in memory.

use bricks::{BRICK_VOXELS, BrickSource};
use display_config::Display;
use glam::DQuat;
use lightloom_tests::memory::{forget_peak, peak_mib};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scanned_head::{self, DIMS};
use lightloom_tests::{compare, draw, scenes};
use optics::{Light, Quality};
use protocol::{CasterChoice, DeviceChoice, FrameState, Pace};
use std::sync::Arc;

/// Views whose pictures are compared with the reference.
const COMPARED: usize = 3;
/// Every so many pixels of them, along x and y.
const COMPARED_STRIDE: u32 = 12;

/// Which views are drawn, and what of them is compared.
struct Plan {
    display: Display,
    source: Arc<dyn BrickSource>,
    projectors: Vec<u32>,
    keep: Vec<u32>,
}

/// Draws all scenes at all settings with one device.
fn measure_device(plan: &Plan, device: DeviceChoice, part: &'static str) -> Result<(), String> {
    let Plan { display, source, projectors, keep } = plan;
    let mut results = Results::new(Program::Bench("all_views"), "all_views", part);
    let place = scenes::placed(&**source, 0.75, DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2));
    let one_voxel =
        Quality { step_voxels: 1.0, tolerance: f64::INFINITY, lod_scale: 0.0, ..Quality::default() };
    let loose = Quality { tolerance: 3e-3, ..Quality::default() };
    let mut settings = vec![
        ("default", Quality::default(), CasterChoice::Rays),
        ("a tolerance of 3e-3", loose, CasterChoice::Rays),
        ("one-voxel steps, finest level", one_voxel, CasterChoice::Rays),
    ];
    if device != DeviceChoice::Cpu {
        // Those of the CPU are measured by the bench `planes`.
        settings.insert(1, ("default, by row planes", Quality::default(), CasterChoice::Planes));
    }
    results.line(format!("{} of 72 views\n", projectors.len()));
    results.line(
        "| scene | setting | seconds | Msamples/s | Gsamples | RMS, 99.9 %, largest error of 255 | peak MiB |",
    );
    results.line("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    for (scene, optics, light) in [
        ("semi-transparent", scanned_head::semi_transparent(), None),
        ("opaque, shaded", scanned_head::opaque(), Some(Light::default())),
    ] {
        for &(setting, quality, caster) in &settings {
            let mut frame = scenes::frame(display, place, optics.clone(), light);
            frame.quality = quality;
            let with = draw::With { cache_bytes: 512 << 20, caster, ..draw::With::device(device) };
            let (mut renderer, info) = draw::renderer(display, source, projectors, with);
            results.drawn_by(&info.adapter);
            if device != DeviceChoice::Cpu {
                // The first frame compiles kernels.
                draw::timed(&mut renderer, &frame, &[]);
            }
            let (seconds, report, images) = draw::timed(&mut renderer, &frame, keep);
            let peak_mib = peak_mib();
            drop(renderer);
            let truth = compare::truth(display, &frame, source, keep, COMPARED_STRIDE);
            let errors = compare::errors(&images, &truth);
            let rate = report.samples as f64 / seconds / 1e6;
            let whole = if report.complete { "" } else { ", INCOMPLETE" };
            results.line(format!(
                "| {scene} | {setting} | {seconds:.2} | {rate:.0} | {:.2} | {}{whole} | {peak_mib:.0} |",
                report.samples as f64 / 1e9,
                compare::codes(&errors),
            ));
        }
    }
    results.finish()
}

/// What more views cost in memory: a cache and an index serve them all.
fn measure_memory(plan: &Plan) -> Result<(), String> {
    let Plan { display, source, .. } = plan;
    let mut results = Results::new(Program::Bench("all_views"), "all_views", "memory");
    let place = scenes::placed(&**source, 0.75, DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2));
    let frame = scenes::frame(display, place, scanned_head::semi_transparent(), None);
    let live = Pace::Live { upload_bytes: 64 << 20, fade_s: 0.4 };
    results.line("| views | frame | bricks | of these, MiB | peak of the process, MiB |");
    results.line("| ---: | --- | ---: | ---: | ---: |");
    for views in [1, 8, 72] {
        for (name, pace) in [("complete", Pace::Complete), ("live", live)] {
            forget_peak().map_err(|error| error.to_string())?;
            let with = draw::With { cache_bytes: 512 << 20, ..draw::With::device(DeviceChoice::Cpu) };
            let (mut renderer, info) = draw::renderer(display, source, &spread_over(views), with);
            results.drawn_by(&info.adapter);
            // What a live frame shows has been asked for by a complete one.
            let (_, report, _) = draw::timed(&mut renderer, &frame, &[]);
            draw::timed(&mut renderer, &FrameState { pace, ..frame.clone() }, &[]);
            drop(renderer);
            let bricks = report.bricks_wanted;
            let mib = (2 * bricks * BRICK_VOXELS as u64) >> 20;
            results.line(format!("| {views} | {name} | {bricks} | {mib} | {:.0} |", peak_mib()));
        }
    }
    results.finish()
}

/// So many projectors of the display, evenly spread.
fn spread_over(views: usize) -> Vec<u32> {
    (0..views).map(|i| ((2 * i + 1) * 72 / (2 * views)) as u32).collect()
}

fn main() -> Result<(), String> {
    let views: usize =
        std::env::var("LIGHTLOOM_BENCH_VIEWS").ok().and_then(|n| n.parse().ok()).unwrap_or(72).clamp(1, 72);
    let wanted = std::env::var("LIGHTLOOM_BENCH_DEVICES").unwrap_or_else(|_| "cpu,gpu".into());
    let display = Display::load("holo72").expect("a preset");
    let projectors = spread_over(views);
    let keep: Vec<u32> = (0..COMPARED.min(views))
        .map(|i| projectors[(2 * i + 1) * views / (2 * COMPARED.min(views))])
        .collect();
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let source: Arc<dyn BrickSource> = Arc::new(scanned_head::store(folder.path()));
    println!("{} × {} × {} voxels at 8 bits, 0.75 m wide", DIMS.x, DIMS.y, DIMS.z);
    let plan = Plan { display, source, projectors, keep };
    if wanted.contains("memory") {
        return measure_memory(&plan);
    }
    for device in draw::devices() {
        let part = if device == DeviceChoice::Cpu { "cpu" } else { "gpu" };
        if wanted.contains(part) {
            measure_device(&plan, device, part)?;
        }
    }
    Ok(())
}
