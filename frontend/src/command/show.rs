//! A show: a theatre on a display, with back-ends, windows, inputs and records.

use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends, Showing};
use crate::cli::{OutputArg, ReconstructArg, ShowArgs, SwapchainArg};
use crate::drive::{
    Controlled, Desk, Desktop, DriveReport, Dump, Energy, Hands, Input, Plan, Recorder, Screens, Sheet, Sink,
    Status, Taped, Tracked, Trial, run,
};
use crate::report::BackendSummary;
use crate::staging::Theatre;
use control::Budget;
use renderer::output::can_write_into;
use screens::{Acts, Window};
use std::io::IsTerminal;
use std::panic::resume_unwind;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};
use tape::{AttachedFile, Head, Limits, Writer};
use transport::beat::Time;

/// A window that is to be opened, and what it shows.
struct View {
    window: Window,
    acts: Acts,
    sheet: Sheet,
}

/// What is shown, and where it comes from.
pub(super) struct Show<'a> {
    /// What it is called.
    pub title: String,
    pub theatre: Theatre,
    /// Trackers and controllers.
    pub inputs: Vec<inputs::Input>,
    /// The files that it is made of.
    pub files: Vec<PathBuf>,
    /// Frames per second, where not the display's.
    pub rate_hz: Option<f64>,
    /// The tape that it is recorded on, and how large that becomes.
    pub record: Option<(PathBuf, Limits)>,
    /// What else keeps a record.
    pub recorders: Vec<&'a mut (dyn Recorder + Send)>,
}

/// Whether the arguments can be done, before anything is started.
pub(super) fn check(args: &ShowArgs) -> Result<(), FrontendError> {
    for folder in args.out.iter().chain(&args.dump) {
        can_write_into(folder)?;
    }
    if args.swapchain == SwapchainArg::On && args.output != OutputArg::Outputs {
        return Err(FrontendError::Screen(
            "--swapchain on is for windows on outputs: add --output outputs".into(),
        ));
    }
    Ok(())
}

/// The tape that is played, if one is.
pub(super) fn taped(args: &ShowArgs) -> Result<Option<Taped>, FrontendError> {
    let mut tape = args.tape.as_deref().map(|path| Taped::open(path, args.stepped)).transpose()?;
    tape.iter_mut().for_each(Taped::compare_files);
    Ok(tape)
}

/// Shows it until its end. A window wants the main thread, so the show runs beside it.
pub(super) fn show(args: &ShowArgs, show: Show<'_>, taped: Option<Taped>) -> Result<(), FrontendError> {
    // A tape has all that came from them.
    let inputs = if taped.is_some() { &[][..] } else { &show.inputs[..] };
    let tracked = if inputs.is_empty() { None } else { Some(Tracked::start(inputs)?) };
    if !args.has_desktop() {
        return play(args, show, tracked, taped, None);
    }
    let sheet = Sheet::new(show.theatre.display());
    let title = format!("lightloom: {}", show.theatre.display().name);
    let size = sheet.picture();
    let (window_loop, window, acts) = screens::open(&title, size.width, size.height)?;
    let view = View { window, acts, sheet };
    std::thread::scope(|scope| {
        let show = scope.spawn(|| play(args, show, tracked, taped, Some(view)));
        let shown = window_loop.run().map_err(FrontendError::from);
        let played = show.join().unwrap_or_else(|panic| resume_unwind(panic));
        shown.and(played)
    })
}

/// The head of the tape of a show.
fn head(show: &Show<'_>) -> Head {
    let began = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    let attached = |path: &PathBuf| {
        let bytes = std::fs::read(path).ok()?;
        Some(AttachedFile { name: path.display().to_string(), bytes })
    };
    Head {
        show: show.title.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        began_ns: began.as_nanos().try_into().unwrap_or(u64::MAX),
        sources: show.inputs.iter().map(|input| input.name.clone()).collect(),
        settings: [("display".to_owned(), show.theatre.display().name.clone())].into(),
        files: show.files.iter().filter_map(attached).collect(),
        part: 1,
    }
}

/// The show itself.
fn play(
    args: &ShowArgs,
    mut show: Show<'_>,
    mut tracked: Option<Tracked>,
    mut taped: Option<Taped>,
    view: Option<View>,
) -> Result<(), FrontendError> {
    let display = show.theatre.display().clone();
    let backends = Backends::connect(args.drawing.backends, &display)?;
    let wiring = backends.wiring.clone();
    wiring.warning().iter().for_each(|warning| warn(warning));
    let onto_outputs = args.output == OutputArg::Outputs;
    if onto_outputs {
        adapter::check_outputs(&display, &wiring)?;
    }
    let rate_hz = args.rate.or(show.rate_hz).unwrap_or(display.rate_hz);
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
        at: protocol::Screens {
            frontend: screens.is_wanted(),
            outputs: onto_outputs,
            swapchain: args.swapchain.into(),
        },
    };
    let options = args.drawing.options(None);
    let mut record = match show.record.take() {
        Some((path, limits)) => Some(Writer::create(&path, head(&show), limits)?),
        None => None,
    };
    let mut driving = backends.drive(&options, &show.theatre.volume_ref(), &display, &showing)?;
    let mut inputs: Vec<&mut dyn Input> = hands.iter_mut().map(|hands| hands as &mut dyn Input).collect();
    inputs.extend(tracked.iter_mut().map(|tracked| tracked as &mut dyn Input));
    inputs.extend(taped.iter_mut().map(|taped| taped as &mut dyn Input));
    let mut recorders: Vec<&mut dyn Recorder> =
        record.iter_mut().map(|tape| tape as &mut dyn Recorder).collect();
    recorders.extend(show.recorders.iter_mut().map(|recorder| &mut **recorder as &mut dyn Recorder));
    // Where frames must be the same whenever they are drawn, nothing may depend on how long they take.
    let trial = if args.stepped { None } else { Trial::new(options.caster, showing.period) };
    let control = args.control.map(|rule| Controlled::new(rule, budget(args.stepped, showing.period)));
    if control.is_some() {
        driving = driving.controlled();
    }
    let plan = Plan { frames: args.frames, time: args.time, trial, control };
    let energy = Energy::begin();
    let is_talking = !args.quiet && !args.json;
    let mut status = Status::new(is_talking && std::io::stderr().is_terminal());
    let desk = Desk { inputs, recorders, tell: &mut |sentence: &str| warn(sentence) };
    let played = run(&mut driving, &mut show.theatre, desk, &mut screens, &plan, &mut status)?;
    drop(status);
    record.map_or(Ok(()), Writer::finish)?;
    let report = DriveReport {
        scene: show.title.clone(),
        display: display.name.clone(),
        projectors: display.projectors.len(),
        rate_hz,
        reconstructs: args.reconstruct == ReconstructArg::Quincunx,
        control: args.control,
        joules: energy.joules(),
        stepped: args.stepped,
        seconds: played.length.as_secs_f64(),
        backends: BackendSummary::all(&wiring, driving.devices().to_vec()),
        played,
    };
    driving.finish()?;
    finish(args, &report)
}

/// Units of a picture that a tick casts in a stepped show: a quarter, so that what is shown becomes finer as it does on time.
const STEPPED_UNITS: u32 = 16;
/// The part of a period that a tick may cast for; the rest is for messages, and for making pictures of what is cast.
const CASTING: f64 = 0.7;

/// How much of a picture a tick casts.
fn budget(is_stepped: bool, period: Duration) -> Budget {
    if is_stepped { Budget::Fixed(STEPPED_UNITS) } else { Budget::of_time(period.mul_f64(CASTING)) }
}

fn finish(args: &ShowArgs, report: &DriveReport) -> Result<(), FrontendError> {
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
