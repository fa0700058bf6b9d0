//! What bent light errs and costs, by the tolerance that it is asked for: the CPU device against the reference.
//!
//! `cargo run --release -p lightloom-tests --example refraction`. Pixels whose truth the reference does not reach are
//! counted, and compared with what it has. Whole pictures of the cranium have rays that graze a surface: which of its pixels rounding
//! alone takes as far as they are off is told by their condition.

use display_config::Display;
use lightloom_tests::compare::{self, Errors, TruePixel};
use lightloom_tests::draw::{With, draw_with, renderer};
use lightloom_tests::random_scene::{Judge, Truth};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes::TestScene;
use lightloom_tests::techniques;
use protocol::{DeviceChoice, FilterChoice, FrameReport, ProjectorImage};
use std::time::Instant;

const PROJECTORS: [u32; 2] = [1, 5];
const TOLERANCES: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];
const WHOLE_TOLERANCES: [f64; 3] = [1e-4, 3e-5, 1e-5];
const STRIDE: u32 = 4;
/// What tells that a pixel is off.
const CODE: f64 = 1.0 / 255.0;

/// Its pictures, by a renderer of its own, and how long they took, seconds.
fn drawn(display: &Display, scene: &TestScene) -> (Vec<ProjectorImage>, FrameReport, f64) {
    let with = With { filter: FilterChoice::Exact, ..With::device(DeviceChoice::Cpu) };
    let (mut renderer, _) = renderer(display, &scene.source, &PROJECTORS, with);
    let began = Instant::now();
    let (images, report) = draw_with(&mut renderer, &scene.frame);
    (images, report, began.elapsed().as_secs_f64())
}

/// Errors in codes, as cells of a row.
fn cells(errors: &Errors) -> String {
    let [rms, p999, max] = [errors.rms, errors.p999, errors.max].map(|error| 255.0 * error);
    format!("{rms:.3} | {p999:.2} | {max:.1}")
}

fn display(width: u32, height: u32) -> Display {
    Display::load("desk8").expect("a preset").with_rasters(width, height)
}

fn by_tolerance() -> Result<(), String> {
    let display = display(160, 120);
    let mut results = Results::new(Program::Study("refraction"), "refraction", "tolerance");
    results.line("| scene | tolerance | samples per ray | seconds | RMS | 99.9 % | largest | not reached |");
    results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for base in techniques::bases(&display) {
        let mut scene = techniques::with(&base, "refraction");
        let truth = compare::traced(&display, &scene.frame, &scene.source, &PROJECTORS, STRIDE);
        let missed = truth.iter().filter(|pixel| !pixel.truth.reached).count();
        for tolerance in TOLERANCES {
            scene.frame.quality.tolerance = tolerance;
            let (images, report, seconds) = drawn(&display, &scene);
            let errors = compare::errors(&images, &truth);
            let per_ray = report.samples as f64 / report.rays as f64;
            results.line(format!(
                "| {} | {tolerance:e} | {per_ray:.1} | {seconds:.2} | {} | {missed} of {} |",
                base.name,
                cells(&errors),
                truth.len()
            ));
        }
    }
    results.finish()
}

/// Whole pictures of the cranium: those that the tests of techniques look at.
fn whole() -> Result<(), String> {
    let display = display(320, 240);
    let bases = techniques::bases(&display);
    let base = bases.iter().find(|base| base.name == "cranium").expect("the CT is a base");
    let mut scene = techniques::with(base, "refraction");
    let truth = Truth::new(&display, &scene.frame, &scene.source, &PROJECTORS, STRIDE);
    let [known, unknown] = truth.known();
    let mut results = Results::new(Program::Study("refraction"), "refraction", "whole");
    results.line(
        "| tolerance | samples per ray | seconds | RMS | 99.9 % | largest | pixels off by a code | of these by rounding | \
         RMS of all others | 99.9 % | largest |",
    );
    results.line("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for tolerance in WHOLE_TOLERANCES {
        scene.frame.quality.tolerance = tolerance;
        let (images, report, seconds) = drawn(&display, &scene);
        let per_ray = report.samples as f64 / report.rays as f64;
        let judge = Judge::new(&truth, 1.0, &scene.frame.quality);
        let [ill, _] = judge.beyond(&images);
        let is_off = |pixel: &&TruePixel| compare::errors(&images, &[**pixel]).max > CODE;
        let off = truth.pixels.iter().filter(is_off).count();
        let by_rounding = ill.iter().map(|&i| &truth.pixels[i]).filter(is_off).count();
        let others = truth.pixels.iter().enumerate().filter(|(i, _)| !ill.contains(i));
        let others: Vec<TruePixel> = others.map(|(_, pixel)| *pixel).collect();
        let [all, others] = [&truth.pixels, &others].map(|pixels| cells(&compare::errors(&images, pixels)));
        results.line(format!(
            "| {tolerance:e} | {per_ray:.1} | {seconds:.2} | {all} | {off} of {known} | {by_rounding} | {others} |"
        ));
    }
    results.line(format!("\n{unknown} of {} pixels have no truth.", known + unknown));
    results.finish()
}

fn main() -> Result<(), String> {
    by_tolerance()?;
    whole()
}
