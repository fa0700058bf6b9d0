//! `lightloom drive`.

use super::look::{ask_for_look, tell_look};
use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends, Showing};
use crate::cli::{DriveArgs, OutputArg, ReconstructArg};
use crate::drive::{
    Desktop, DriveReport, Dump, Hands, Input, Plan, Screens, Sheet, Sink, Status, Tracked, Trial, one_hand,
    run,
};
use crate::report::BackendSummary;
use crate::scene::Scene;
use crate::staging::{Piece, Theatre};
use protocol::Pace;
use renderer::output::can_write_into;
use screens::{Acts, Window};
use std::io::IsTerminal;
use std::panic::resume_unwind;
use std::time::Duration;
use transport::beat::Time;
use world::Cast;

/// A window that is to be opened, and what it shows.
struct View {
    window: Window,
    acts: Acts,
    sheet: Sheet,
}

/// Drives a display. All that can be wrong with the arguments is found before any back-end starts. A window wants the main
/// thread, so the show runs beside it.
pub(super) fn drive(args: &DriveArgs) -> Result<(), FrontendError> {
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(&args.display)?;
    ask_for_look(&mut scene, args.look);
    let (facts, look) = adapter::meet_volume(&mut scene)?;
    scene.check_frames(0..scene.frame_count.max(1), &display, &facts)?;
    let looks = adapter::looks_of(&scene, look.as_ref())?;
    for folder in args.out.iter().chain(&args.dump) {
        can_write_into(folder)?;
    }
    if !args.quiet && !args.json {
        tell_look(look.as_ref())?;
    }
    let inputs = args.inputs.as_deref().map(inputs::Input::load).transpose()?;
    let tracked = inputs.as_deref().map(Tracked::start).transpose()?;
    let has_sub_frames = args.reconstruct == ReconstructArg::Quincunx;
    // Where nothing is late, nothing needs to be missing.
    let pace = if args.stepped { Pace::Complete } else { args.pace() };
    let cast = if tracked.is_some() { one_hand() } else { Cast::default() };
    let piece = Piece::new(scene, facts, &looks);
    let theatre = Theatre::of_one(piece, cast, display, pace).with_sub_frames(has_sub_frames);
    if !args.has_desktop() {
        return play(args, theatre, tracked, None);
    }
    let sheet = Sheet::new(theatre.display());
    let title = format!("lightloom: {}", theatre.display().name);
    let size = sheet.picture();
    let (window_loop, window, acts) = screens::open(&title, size.width, size.height)?;
    let view = View { window, acts, sheet };
    std::thread::scope(|scope| {
        let show = scope.spawn(|| play(args, theatre, tracked, Some(view)));
        let shown = window_loop.run().map_err(FrontendError::from);
        let played = show.join().unwrap_or_else(|panic| resume_unwind(panic));
        shown.and(played)
    })
}

/// The show itself.
fn play(
    args: &DriveArgs,
    mut theatre: Theatre,
    mut tracked: Option<Tracked>,
    view: Option<View>,
) -> Result<(), FrontendError> {
    let display = theatre.display().clone();
    let backends = Backends::connect(args.drawing.backends, &display)?;
    let wiring = backends.wiring.clone();
    wiring.warning().iter().for_each(|warning| warn(warning));
    let onto_outputs = args.output == OutputArg::Outputs;
    if onto_outputs {
        adapter::check_outputs(&display, &wiring)?;
    }
    let rate_hz = args.rate.unwrap_or(display.rate_hz);
    let time = if args.stepped { Time::stepped() } else { Time::Real };
    let (mut hands, mut desktop) = (None, None);
    if let Some(View { window, acts, sheet }) = view {
        hands = Some(Hands::new(acts, &display, &sheet));
        desktop = Some(Desktop::new(window, sheet));
    }
    let mut dump = args.dump.clone().map(Dump::into).transpose()?;
    let sinks: Vec<&mut dyn Sink> = [
        desktop.as_mut().map(|desktop| desktop as &mut dyn Sink),
        dump.as_mut().map(|dump| dump as &mut dyn Sink),
    ]
    .into_iter()
    .flatten()
    .collect();
    let mut screens = Screens::new(sinks);
    let showing = Showing {
        period: Duration::from_secs_f64(1.0 / rate_hz),
        time,
        at: protocol::Screens { frontend: screens.is_wanted(), outputs: onto_outputs },
    };
    let options = args.drawing.options(None);
    let mut driving = backends.drive(&options, &theatre.volume_ref(), &display, &showing)?;
    let mut inputs: Vec<&mut dyn Input> = hands.iter_mut().map(|hands| hands as &mut dyn Input).collect();
    inputs.extend(tracked.iter_mut().map(|tracked| tracked as &mut dyn Input));
    // Where frames must be the same whenever they are drawn, nothing may depend on how long they take.
    let trial = if args.stepped { None } else { Trial::new(options.caster, showing.period) };
    let plan = Plan { frames: args.frames, time: args.time, trial };
    let is_talking = !args.quiet && !args.json;
    let mut status = Status::new(is_talking && std::io::stderr().is_terminal());
    let mut tell = |sentence: &str| warn(sentence);
    let played = run(&mut driving, &mut theatre, &mut inputs, &mut screens, &plan, &mut status, &mut tell)?;
    drop(status);
    let report = DriveReport {
        scene: theatre.name().to_owned(),
        display: display.name.clone(),
        projectors: display.projectors.len(),
        rate_hz,
        reconstructs: args.reconstruct == ReconstructArg::Quincunx,
        stepped: args.stepped,
        seconds: played.length.as_secs_f64(),
        backends: BackendSummary::all(&wiring, driving.devices().to_vec()),
        played,
    };
    driving.finish()?;
    finish(args, &report)
}

fn finish(args: &DriveArgs, report: &DriveReport) -> Result<(), FrontendError> {
    if let Some(folder) = &args.out {
        report.write(folder)?;
    }
    if args.json {
        say(&serde_json::to_string_pretty(report)?)?;
    } else if !args.quiet {
        say(&report.line())?;
    }
    Ok(())
}
