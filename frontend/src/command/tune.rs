//! `lightloom tune`.

use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter;
use crate::cli::{TapeChoice, TuneArgs};
use crate::drive::Taped;
use crate::interrupt;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::staging::Piece;
use crate::tune::{
    Footage, Machine, Motion, SHIPPED, Scenario, Study, TUNE_HTML, TuneReport, open_shipped, recorded, write,
};
use bricks::BrickSource;
use control::Weights;
use display_config::Display;
use renderer::output::can_write_into;
use std::cell::RefCell;
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
        let count = match number {
            _ if args.only_tapes => 0,
            0 => 3,
            _ => 2,
        };
        for motion in &own[..count] {
            all.push((motion.scenario(&scene.name, &still, display.height_m), Arc::clone(&source)));
        }
        if !args.tapes.is_empty() {
            let looks = adapter::looks_of(&scene, look.as_ref())?;
            let piece = Piece::new(scene, facts, &looks);
            all.extend(of_tapes(args, &piece, display)?.into_iter().map(|one| (one, Arc::clone(&source))));
        }
    }
    Ok(all)
}

/// What those who are on the tapes make of a piece.
fn of_tapes(args: &TuneArgs, piece: &Piece, display: &Display) -> Result<Vec<Scenario>, FrontendError> {
    let mut tapes = Vec::new();
    for choice in &args.tapes {
        match choice {
            TapeChoice::Shipped => {
                for (name, bytes) in SHIPPED {
                    tapes.push((name.to_owned(), open_shipped(name, bytes)?));
                }
            }
            TapeChoice::File(path) => {
                let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
                tapes.push((name, Taped::open(path, true)?));
            }
        }
    }
    let mut scenarios = Vec::new();
    for (name, tape) in tapes {
        let (scenario, news) = recorded(tape, &name, piece.clone(), display)?;
        news.iter().for_each(|news| warn(news));
        scenarios.push(scenario);
    }
    Ok(scenarios)
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
