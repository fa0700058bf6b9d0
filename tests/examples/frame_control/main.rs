//! How well frames are controlled by error, against fixed rules and against reconstruction in time: seven interactions on
//! three simulated machines, as an eye before desk8 sees them; how far the estimates of error can be trusted; what they cost.
//!
//! `cargo run --release -p lightloom-tests --example frame_control -- [[--tapes] [--pages DIR] | --costs | --rest |
//! --estimates | --points | --played-points]`. The footage is drawn complete first; what a machine of some speed would have shown is then played from it, see
//! `frontend::tune`. With `--tapes` the interactions are those of the tapes that come with the program. `--rest` measures what a display
//! at rest takes, `--estimates` whether errors are told rightly, `--points` and `--played-points` what capacity-constrained points show in place of lattices.

mod costs;
mod estimates;
mod eyes;
mod points;
mod rest;
mod tapes;

use bricks::BrickSource;
use control::Weights;
use display_config::Display;
use frontend::tune::{Footage, Machine, Motion, Scenario, Study, TuneReport, write};
use lightloom_tests::results::{Program, Results};
use lightloom_tests::scenes;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const PAGE: &str = "control";
const PROGRAM: Program = Program::Study("frame_control");
/// Pixels of each projector's picture.
const RASTER: [u32; 2] = [160, 120];
/// Milliseconds that a complete picture takes the machines.
const MACHINES_MS: [u64; 3] = [100, 400, 1600];

fn main() -> Result<(), String> {
    let (mut pages, mut plays_tapes): (Option<PathBuf>, bool) = (None, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--pages" => pages = Some(arguments.next().ok_or("--pages needs a folder")?.into()),
            "--tapes" => plays_tapes = true,
            "--costs" => return costs::measure(),
            "--rest" => return rest::measure(),
            "--estimates" => {
                let display = Display::load("desk8").map_err(|error| error.to_string())?;
                return estimates::compare(&footage(&display)?);
            }
            "--points" => return points::stills(),
            "--played-points" => return points::played(),
            other => {
                let known = "--tapes, --pages DIR, --costs, --rest, --estimates, --points or --played-points";
                return Err(format!("{other} is unknown; give nothing, {known}"));
            }
        }
    }
    let display = Display::load("desk8").map_err(|error| error.to_string())?;
    let report = if plays_tapes {
        tapes::play(Results::new(PROGRAM, PAGE, "tapes"), &display)?
    } else {
        motions(&display)?
    };
    pages.map_or(Ok(()), |folder| {
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        write(&report, &folder).map_err(|error| error.to_string())
    })
}

fn machines() -> Vec<Machine> {
    MACHINES_MS.map(|ms| Machine { full: Duration::from_millis(ms) }).to_vec()
}

/// The study of the seven motions; its report.
fn motions(display: &Display) -> Result<TuneReport, String> {
    let started = Instant::now();
    let study = Study { footage: footage(display)?, machines: machines() };
    estimates::compare(&study.footage)?;
    let played = study.run(Weights::default(), &AtomicBool::new(false), &|| {});
    let (stages, best) = played.ok_or("nobody stops it")?;
    let report = TuneReport::new(&study, &stages, best, started.elapsed().as_secs_f64())
        .map_err(|error| error.to_string())?;
    let mut results = Results::new(PROGRAM, PAGE, "sweeps");
    sweeps(&mut results, &report);
    results.finish()?;
    eyes::compare(&study, best)?;
    costs::measure()?;
    Ok(report)
}

/// Three volumes, each turned and with its extinction changed; one cut by a plane.
fn footage(display: &Display) -> Result<Vec<Footage>, String> {
    let mut footage = Vec::new();
    for (scenario, source) in scenarios(display) {
        let drawn = Footage::draw(&scenario, display, RASTER, &source, &AtomicBool::new(false), &|_| {});
        footage.push(drawn.map_err(|error| error.to_string())?.ok_or("nobody stops it")?);
        eprintln!("{} is drawn", scenario.name);
    }
    Ok(footage)
}

/// The interactions of the footage, with their volumes.
fn scenarios(display: &Display) -> Vec<(Scenario, Arc<dyn BrickSource>)> {
    let small = display.with_rasters(RASTER[0], RASTER[1]);
    let mut all = vec![scenes::shells(&small), scenes::stored_vessels(&small)];
    all.extend(scenes::cranium(&small));
    let mut scenarios = Vec::new();
    for (number, scene) in all.iter().enumerate() {
        let motions = [Motion::Turn, Motion::Look, Motion::Clip];
        for motion in &motions[..if number + 1 == all.len() { 3 } else { 2 }] {
            let scenario = motion.scenario(scene.name, &scene.frame, display.height_m);
            scenarios.push((scenario, Arc::clone(&scene.source)));
        }
    }
    scenarios
}

/// The tables of the stages.
fn sweeps(results: &mut Results, report: &TuneReport) {
    for stage in &report.stages {
        results.line("| setting | bad by RMS | bad by flicker | mean RMS | worst place among all | rays cast for, s | shown a second |");
        results.line("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
        let runs = stage.settings.first().map_or(1, |one| one.scores.len());
        for (place, setting) in stage.settings.iter().enumerate() {
            let mean = |numbers: &mut dyn Iterator<Item = f64>| numbers.sum::<f64>() / runs as f64;
            let rank = |run: usize| {
                let rms = setting.scores[run].rms;
                1 + stage.settings.iter().filter(|other| other.scores[run].rms < rms).count()
            };
            results.line(format!(
                "| {}{} | {:.3} | {:.3} | {:.2} | {} of {} | {:.1} | {:.1} |",
                setting.name,
                if place == stage.best { " **best**" } else { "" },
                setting.badness,
                setting.badness_by_flicker,
                255.0 * mean(&mut setting.scores.iter().map(|score| score.rms)),
                (0..runs).map(rank).max().unwrap_or(1),
                stage.settings.len(),
                setting.busy_s,
                mean(&mut setting.shown_per_s.iter().copied()),
            ));
        }
        results.line("");
    }
    results.line(format!("Best: ρ = {}, ϑ = {}.", report.best.rho, report.best.theta));
}
