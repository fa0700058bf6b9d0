//! `lightloom simulate`.

use super::look::{ask_for_look, tell_look};
use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends, TraceFolder};
use crate::cli::SimulateArgs;
use crate::progress::Progress;
use crate::report::{self, BackendSummary, Report, units};
use crate::scene::Scene;
use crate::simulate::{Eye, Job};
use std::ops::Range;
use std::time::Instant;

/// Renders, writes and reports. All that can be wrong with the arguments is found before any back-end starts.
pub(super) fn simulate(args: &SimulateArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let traces = args.live.trace.as_deref();
    if traces.is_some() && !args.live.live {
        return Err(FrontendError::TraceOfCompleteFrames);
    }
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(&args.display)?;
    ask_for_look(&mut scene, args.look);
    let (facts, look) = adapter::meet_volume(&mut scene)?;
    let frames = frames(args, &scene)?;
    scene.check_frames(frames.clone(), &display, &facts)?;
    let saved = args.save_scene.as_deref().map(|path| scene.saved(&args.scene, path)).transpose()?;
    let job = Job {
        frames,
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
    let mut drawing = backends.start(&options, &job.scene.volume_ref(), &job.display)?;
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
        say(&format!("{pictures} pictures, {rays} rays, {time}: {}", args.out.join(report::HTML).display()))?;
    }
    Ok(())
}
