//! `lightloom simulate`.

use super::exhibit::load;
use super::look::{ask_for_look, tell_look};
use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends, TraceFolder};
use crate::cli::SimulateArgs;
use crate::drive::{Remade, Taped, cast};
use crate::progress::Progress;
use crate::report::{self, BackendSummary, Report, units};
use crate::scene::{LookChoice, Scene, VolumeFacts};
use crate::simulate::{Eye, Job};
use crate::staging::{Piece, Theatre};
use display_config::Display;
use protocol::{FrameState, Pace};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// Where neither the command line nor an exhibit names one.
const DEFAULT_DISPLAY: &str = "holo72";

/// Renders, writes and reports. All that can be wrong with the arguments is found before any back-end starts.
pub(super) fn simulate(args: &SimulateArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let traces = args.live.trace.as_deref();
    if traces.is_some() && !args.live.live {
        return Err(FrontendError::TraceOfCompleteFrames);
    }
    let Subject { scene, facts, look, display, frames, remade } = match &args.tape {
        Some(tape) => of_tape(args, tape)?,
        None => of_scene(args)?,
    };
    let saved = args.save_scene.as_deref().map(|path| scene.saved(&args.scene, path)).transpose()?;
    let job = Job {
        frames,
        remade,
        pace: args.live.pace(),
        debug: args.debug_view.map(Into::into),
        eyes: args.eyes.iter().map(|&eye| Eye::before(&display, eye)).collect::<Result<_, _>>()?,
        scene,
        facts,
        display,
        out: args.out.clone(),
        exr: args.exr,
        calibrated: args.calibrated,
    };
    Job::prepare_output(&args.out)?;
    if let Some((path, text)) = args.save_scene.as_deref().zip(saved) {
        report::write_text(path, &text)?;
    }
    let trace_folder = traces.map(TraceFolder::prepare).transpose()?;
    let backends = Backends::connect(args.drawing.backends, &job.display)?;
    let wiring = backends.wiring.clone();
    wiring.warning().iter().for_each(|warning| warn(warning));
    let options = args.drawing.options(traces);
    let first = job.remade.values().next().and_then(|frame| frame.volume.clone());
    let volume = first.unwrap_or_else(|| job.scene.volume_ref());
    let mut drawing = backends.start(&options, &volume, &job.display)?;
    let mut progress = Progress::new(!args.quiet && !args.json);
    let drawn = job.run(drawing.source.as_mut(), &mut progress);
    let drawn = drawing.finish(drawn);
    drop(progress);
    trace_folder.map_or(Ok(()), |folder| folder.settle(wiring.shares.len()))?;
    let report = job.report(BackendSummary::all(&wiring, drawing.devices), drawn?, started.elapsed())?;
    report::write(&report, &args.out)?;
    if !args.quiet && !args.json {
        tell_look(look.as_ref())?;
    }
    tell(args, &report)
}

/// What is drawn.
struct Subject {
    scene: Scene,
    facts: VolumeFacts,
    look: Option<LookChoice>,
    display: Display,
    frames: Range<u32>,
    remade: BTreeMap<u32, FrameState>,
}

/// The scene as it is.
fn of_scene(args: &SimulateArgs) -> Result<Subject, FrontendError> {
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(args.display.as_deref().unwrap_or(DEFAULT_DISPLAY))?;
    ask_for_look(&mut scene, args.look);
    let (facts, look) = adapter::meet_volume(&mut scene)?;
    let frames = frames(args, &scene)?;
    scene.check_frames(frames.clone(), &display, &facts)?;
    Ok(Subject { scene, facts, look, display, frames, remade: BTreeMap::new() })
}

/// What was made of a scene, or of an exhibit, when a tape was recorded.
fn of_tape(args: &SimulateArgs, tape: &Path) -> Result<Subject, FrontendError> {
    let display = args.display.as_deref().map(adapter::load_display).transpose()?;
    let tape = Taped::open(tape, true)?;
    let is_exhibit = adapter::is_exhibit(&args.scene);
    let (mut theatre, look) = if is_exhibit {
        refuse_what_is_for_scenes(args)?;
        let (exhibit, ensemble, own) = load(Path::new(&args.scene))?;
        let theatre = Theatre::new(ensemble, display.unwrap_or(own), Pace::Complete);
        (theatre.with_marks(exhibit.marks), None)
    } else {
        let Subject { scene, facts, look, display, .. } =
            of_scene(&SimulateArgs { frames: None, ..args.clone() })?;
        let looks = adapter::looks_of(&scene, look.as_ref())?;
        let piece = Piece::new(scene, facts, &looks);
        (Theatre::of_one(piece, cast(tape.has_inputs()), display, Pace::Complete), look)
    };
    theatre = theatre.with_sub_frames(false);
    let Remade { frames: mut remade, news } = tape.remake(args.frames, &mut theatre)?;
    news.iter().for_each(|news| warn(news));
    let ends = remade.keys().next().zip(remade.keys().next_back());
    let frames = ends.map_or(0..0, |(&first, &last)| first..last + 1);
    let (mut scene, facts, display) = (theatre.scene().clone(), *theatre.facts(), theatre.display().clone());
    // Only now: the frames of an exhibit were compared with those on the tape, which have the exhibit's own quality.
    if let Some(preset) = args.quality.filter(|_| is_exhibit) {
        scene.quality = preset.quality();
        remade.values_mut().for_each(|frame| frame.quality = preset.quality());
    }
    Ok(Subject { scene, facts, look, display, frames, remade })
}

fn refuse_what_is_for_scenes(args: &SimulateArgs) -> Result<(), FrontendError> {
    let asked = [("--look", args.look.is_some()), ("--save-scene", args.save_scene.is_some())];
    match asked.into_iter().find(|asked| asked.1) {
        Some((option, _)) => Err(FrontendError::NotForExhibits { option }),
        None => Ok(()),
    }
}

fn frames(args: &SimulateArgs, scene: &Scene) -> Result<Range<u32>, FrontendError> {
    let (first, end) = args.frames.unwrap_or((0, scene.frame_count));
    if end > scene.frame_count {
        return Err(FrontendError::Frames { first, end, count: scene.frame_count });
    }
    Ok(first..end)
}

fn tell(args: &SimulateArgs, report: &Report) -> Result<(), FrontendError> {
    for frame in report.frames.iter().filter(|frame| !frame.total.complete) {
        warn(&format!("frame {} is not complete: {}", frame.index, frame.total.shortfall.join("; ")));
    }
    report.eye_warnings().for_each(|warning| warn(&warning));
    if args.json {
        say(&serde_json::to_string_pretty(report)?)?;
    } else if !args.quiet {
        let pictures: usize = report.frames.iter().map(|frame| frame.pictures.len()).sum();
        let rays = units::count(report.total.rays);
        let time = units::milliseconds(report.wall_ms);
        report.live.iter().try_for_each(|live| say(&live.line()))?;
        say(&format!("{pictures} pictures, {rays} rays, {time}: {}", args.out.join(report::HTML).display()))?;
    }
    Ok(())
}
