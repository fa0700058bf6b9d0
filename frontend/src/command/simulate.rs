//! `lightloom simulate`.

use super::{say, warn};
use crate::FrontendError;
use crate::cli::SimulateArgs;
use crate::progress::Progress;
use crate::report::{self, Report, units};
use crate::scene::{Scene, VolumeFacts};
use crate::session::{self, Backends};
use crate::simulate::{Eye, Job};
use display_config::Display;
use protocol::FrameState;
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
    let display = session::load_display(&args.display)?;
    let facts = session::volume_facts(&scene.volume_ref())?;
    let job = Job {
        frames: frames(args, &scene, &display, &facts)?,
        eyes: args.eyes.iter().map(|&eye| Eye::before(&display, eye)).collect::<Result<_, _>>()?,
        display,
        out: args.out.clone(),
        exr: args.exr,
    };
    Job::prepare_output(&args.out)?;
    traces.map_or(Ok(()), session::prepare_traces)?;
    let backends = Backends::connect(args.drawing.backends)?;
    let setups = session::setups(&args.drawing, &scene.volume_ref(), &job.display, backends.count(), traces)?;
    let (mut source, devices) = backends.start(setups)?;
    let mut progress = Progress::new(!args.quiet && !args.json);
    let frames = job.run(source.as_mut(), &mut progress)?;
    source.finish()?;
    drop(progress);
    let report = Report::new(&scene, &facts, &job, devices, frames, started.elapsed());
    report::write(&report, &args.out)?;
    tell(args, &report)
}

fn frames(
    args: &SimulateArgs,
    scene: &Scene,
    display: &Display,
    facts: &VolumeFacts,
) -> Result<Vec<FrameState>, FrontendError> {
    let (first, end) = args.frames.unwrap_or((0, scene.frame_count));
    if end > scene.frame_count {
        return Err(FrontendError::Frames { first, end, count: scene.frame_count });
    }
    let (pace, debug) = (args.live.pace(), args.debug_view.map(Into::into));
    let frame = |index| Ok(FrameState { pace, debug, ..scene.frame(index, display, facts)? });
    (first..end).map(frame).collect()
}

fn tell(args: &SimulateArgs, report: &Report) -> Result<(), FrontendError> {
    for frame in report.frames.iter().filter(|frame| !frame.total.complete) {
        warn(&format!("frame {} is not complete: {}", frame.index, frame.total.shortfall.join("; ")));
    }
    report.eye_warnings().for_each(|warning| warn(&warning));
    if args.json {
        say(&serde_json::to_string_pretty(report)?);
    } else if !args.quiet {
        let pictures: usize = report.frames.iter().map(|frame| frame.pictures.len()).sum();
        let rays = units::count(report.total.rays);
        let time = units::milliseconds(report.wall_ms);
        say(&format!("{pictures} pictures, {rays} rays, {time}: {}", args.out.join(report::HTML).display()));
    }
    Ok(())
}
