//! `lightloom tune`.

use super::drive::cast;
use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter;
use crate::cli::TuneArgs;
use crate::drive::{Remade, Taped};
use crate::interrupt;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::staging::{Piece, Theatre};
use crate::tune::{Footage, Machine, Motion, Scenario, Study, TUNE_HTML, TuneReport, write};
use bricks::BrickSource;
use control::Weights;
use display_config::Display;
use protocol::Pace;
use renderer::output::can_write_into;
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The part of the work that is drawing the footage, as far as a progress bar goes.
const DRAWING: f64 = 0.4;

/// A scenario, and the volume that it shows.
type Shown = (Scenario, Arc<dyn BrickSource>);

/// Draws, plays, writes and reports. All that can be wrong with the arguments is found before any ray is cast.
pub(super) fn tune(args: &TuneArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let stop = interrupt::stop_flag()?;
    let display = adapter::load_display(&args.display)?;
    can_write_into(&args.out)?;
    let scenarios = scenarios(args, &display)?;
    let progress = RefCell::new(Progress::new(!args.quiet && !args.json));
    let Some(footage) = draw(args, &display, &scenarios, &stop, &progress)? else { return Err(stopped()) };
    let machines = args.machines.iter().map(|&full| Machine { full }).collect();
    let study = Study { footage, machines };
    let (done, runs) = (AtomicUsize::new(0), study.runs());
    let bar = Mutex::new(progress.into_inner());
    let shown = || {
        let done = done.fetch_add(1, Ordering::Relaxed) as f64 / runs as f64;
        let mut bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        bar.set(DRAWING + (1.0 - DRAWING) * done, "playing");
    };
    let Some((stages, best)) = study.run(Weights::default(), &stop, &shown) else {
        return Err(stopped());
    };
    drop(bar);
    let report = TuneReport::new(&study, &stages, best, started.elapsed().as_secs_f64())?;
    write(&report, &args.out)?;
    if args.json {
        say(&serde_json::to_string_pretty(&report)?)?;
    } else if !args.quiet {
        let place = args.out.join(TUNE_HTML);
        say(&format!("best: ρ = {}, ϑ = {}; {}", report.best.rho, report.best.theta, place.display()))?;
    }
    Ok(())
}

fn stopped() -> FrontendError {
    FrontendError::Stopped("stopped before anything was judged; nothing is written".to_owned())
}

/// What is played of each scene, and of the tapes.
fn scenarios(args: &TuneArgs, display: &Display) -> Result<Vec<Shown>, FrontendError> {
    let mut all = Vec::new();
    for (number, name) in args.scenes.iter().enumerate() {
        let mut scene = Scene::load(name)?;
        scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
        let (facts, look) = adapter::meet_volume(&mut scene)?;
        let source = adapter::open_scene_volume(&scene)?;
        let still = scene.frame(0, display, &facts)?;
        let own = [Motion::Turn, Motion::Look, Motion::Clip];
        for motion in &own[..if number == 0 { 3 } else { 2 }] {
            all.push((motion.scenario(&scene.name, &still, display.height_m), Arc::clone(&source)));
        }
        if number == 0 {
            let looks = adapter::looks_of(&scene, look.as_ref())?;
            for tape in &args.tapes {
                let piece = Piece::new(scene.clone(), facts, &looks);
                all.push((of_tape(tape, piece, display)?, Arc::clone(&source)));
            }
        }
    }
    Ok(all)
}

/// What a tape made of a piece, at each sixtieth of a second.
fn of_tape(path: &Path, piece: Piece, display: &Display) -> Result<Scenario, FrontendError> {
    let tape = Taped::open(path, true)?;
    let mut theatre = Theatre::of_one(piece, cast(tape.has_inputs()), display.clone(), Pace::Complete)
        .with_sub_frames(false);
    let all = (0, tape.len());
    let Remade { frames, news } = tape.remake(Some(all), &mut theatre)?;
    news.iter().for_each(|news| warn(news));
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Ok(Scenario::sampled(name, frames.into_values()))
}

/// The footage of all scenarios; None where somebody asked to stop.
fn draw(
    args: &TuneArgs,
    display: &Display,
    scenarios: &[Shown],
    stop: &AtomicBool,
    progress: &RefCell<Progress>,
) -> Result<Option<Vec<Footage>>, FrontendError> {
    let all: usize = scenarios.iter().map(|(scenario, _)| scenario.states.len()).sum();
    let (mut footage, mut before) = (Vec::new(), 0);
    for (scenario, source) in scenarios {
        let shown = |instants: usize| {
            let part = (before + instants) as f64 / all.max(1) as f64;
            progress.borrow_mut().set(DRAWING * part, "drawing");
        };
        let size = [args.size.x, args.size.y];
        let Some(drawn) = Footage::draw(scenario, display, size, source, stop, &shown)? else {
            return Ok(None);
        };
        footage.push(drawn);
        before += scenario.states.len();
    }
    Ok(Some(footage))
}
