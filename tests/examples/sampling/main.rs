//! Samples per ray against error: with blending and without, and with steps of one length, as a table in Markdown.
//!
//! `cargo run --release -p lightloom-tests --example sampling`. Shells of 700³ on holo72, three depths at once, CPU device.
//! Each error is against the reference of the same setting: what sampling costs, not what levels of detail leave out.
//! Samples are those of a second picture, when every brick is there; gradients, and what a sample fetches of the level above
//! its own, are not counted but take time: seconds are those of the casts alone, the median of seven pictures. Those are counted
//! in a second table, by the twin in numbers that count what it looks up.

mod counted;

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use counted::{Counted, LookUps};
use display_config::Display;
use glam::{DQuat, EulerRot, UVec3};
use lightloom_tests::compare;
use lightloom_tests::draw::{self, With, draw_with};
use lightloom_tests::remembered::Remembered;
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes;
use lightloom_tests::twin_scene::{TwinScene, view};
use optics::{Light, Quality};
use protocol::{DeviceChoice, FrameState};
use std::sync::Arc;

/// Near the middle.
const PROJECTORS: [u32; 1] = [36];
/// Voxels along an edge.
const EDGE: u32 = 700;
/// Pixels between those that are compared.
const STRIDE: u32 = 4;
/// Pictures that are timed.
const REPEATS: usize = 7;

fn main() -> Result<(), String> {
    let display = Display::load("holo72").map_err(|e| e.to_string())?.with_rasters(320, 240);
    let volume =
        ProceduralVolume::new("shells", UVec3::splat(EDGE), 1e-3).map_err(|error| error.to_string())?;
    let source: Arc<dyn BrickSource> = Arc::new(Remembered::new(Arc::new(volume)));
    let mut optics = scenes::shells(&display).frame.optics;
    // The scene's own volume has 128 voxels along an edge.
    optics.extinction = scenes::scaled(&optics.extinction, 128.0 / f64::from(EDGE));
    let place = scenes::placed(&*source, 1.2, DQuat::from_euler(EulerRot::XYZ, 0.4, 0.7, 0.1));
    let frame = scenes::frame(&display, place, optics, Some(Light::default()));

    let default = Quality::default();
    let unblended = Quality { blended: false, ..default };
    let uniform = |step_voxels| Quality { step_voxels, tolerance: f64::INFINITY, ..unblended };
    // On the finest level everywhere a step of one length is the same number of metres all along a ray.
    let finest = |step_voxels| Quality { lod_scale: 0.0, ..uniform(step_voxels) };
    let mut settings = vec![("blended", default), ("not blended", unblended)];
    settings.extend([2.0, 1.0, 0.5, 0.25].map(|step| ("one length in each node", uniform(step))));
    settings.extend([4.0, 2.0, 1.0, 0.5].map(|step| ("one length along the ray", finest(step))));

    errors(&display, &source, &frame, &settings)?;
    look_ups(&display, &source, &frame, &settings)
}

/// What each setting costs, and how far it is from the truth.
fn errors(
    display: &Display,
    source: &Arc<dyn BrickSource>,
    frame: &FrameState,
    settings: &[(&str, Quality)],
) -> Result<(), String> {
    let mut results = Results::new(Program::Study("sampling"), "sampling", "sampling");
    results.line("| steps | longest, voxels | samples per ray | cast, s | ns a sample | RMS / 99.9 % / largest of 255 |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: |");
    for &(name, quality) in settings {
        let frame = FrameState { quality, ..frame.clone() };
        let with = With { cache_bytes: 2 << 30, ..With::device(DeviceChoice::Cpu) };
        let (mut renderer, info) = draw::renderer(display, source, &PROJECTORS, with);
        results.drawn_by(&info.adapter);
        draw_with(&mut renderer, &frame);
        let (images, report) = draw_with(&mut renderer, &frame);
        if !report.complete {
            return Err(report.shortfall);
        }
        let mut casts: Vec<f64> =
            (0..REPEATS).map(|_| draw_with(&mut renderer, &frame).1.stages.cast_ms / 1e3).collect();
        casts.sort_by(f64::total_cmp);
        let cast_s = casts[REPEATS / 2];
        let pixels: u64 = images.iter().map(|image| u64::from(image.width) * u64::from(image.height)).sum();
        let truth = compare::truth(display, &frame, source, &PROJECTORS, STRIDE);
        let errors = compare::errors(&images, &truth);
        results.line(format!(
            "| {name} | {} | {:.1} | {cast_s:.3} | {:.1} | {:.3} / {:.2} / {:.1} |",
            quality.step_voxels,
            report.samples as f64 / pixels as f64,
            1e9 * cast_s / report.samples as f64,
            255.0 * errors.rms,
            255.0 * errors.p999,
            255.0 * errors.max
        ));
    }
    results.finish()
}

/// What each setting looks up, by a twin that passes over nothing within a node.
fn look_ups(
    display: &Display,
    source: &Arc<dyn BrickSource>,
    frame: &FrameState,
    settings: &[(&str, Quality)],
) -> Result<(), String> {
    let mut results = Results::new(Program::Study("sampling"), "sampling", "look-ups");
    results.line("| steps | longest, voxels | samples per ray | scalars of parents besides | gradients | codes read per ray | per sample |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for &(name, quality) in settings {
        let frame = FrameState { quality, ..frame.clone() };
        let scene = TwinScene::new(display, &frame, &**source);
        let view = view(display, PROJECTORS[0], &frame, &**source).within::<Counted>();
        let [width, height] = view.rays.raster;
        let columns = || (0..width).step_by(STRIDE as usize);
        let rows = (0..height).step_by(STRIDE as usize);
        let pixels: Vec<(u32, u32)> = rows.flat_map(|y| columns().map(move |x| (x, y))).collect();
        LookUps::take();
        let samples: u64 = scene.cast_whole(&view, &pixels).iter().map(|cast| u64::from(cast.samples)).sum();
        let LookUps { scalars, gradients } = LookUps::take();
        let codes = 8 * scalars + 32 * gradients;
        let of_ray = |count: u64| count as f64 / pixels.len() as f64;
        results.line(format!(
            "| {name} | {} | {:.1} | {:.1} | {:.1} | {:.0} | {:.1} |",
            quality.step_voxels,
            of_ray(samples),
            of_ray(scalars - samples),
            of_ray(gradients),
            of_ray(codes),
            codes as f64 / samples as f64
        ));
    }
    results.finish()
}
