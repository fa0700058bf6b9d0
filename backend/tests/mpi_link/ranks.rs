//! What the ranks of a test job do.

use crate::job::{CASE, CASE_LIMIT, DIRECTORY};
use display_config::Display;
use glam::{DAffine3, DVec3};
use optics::{Curve, Optics};
use protocol::{
    Advance, CodesAt, DeviceInfo, Draw, DrawError, FrameReport, FrameState, FromBackend, FromFrontend,
    ProjectorImage, Render, RenderEvent, RendererOptions, ScreenPicture, Screens, Setup, Stages, StopAsked,
    VolumeRef, wire,
};

use signal_hook::{
    consts::{SIGKILL, SIGSTOP},
    low_level::raise,
};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};
use std::{env, fs, process, thread};
use transport::beat::{Drive, Happening, Time};
use transport::*;

const CULPRIT: u32 = 1;

fn case() -> String {
    env::var(CASE).unwrap_or_default()
}

fn note(name: &str, content: impl AsRef<[u8]>) {
    let directory = env::var_os(DIRECTORY).expect("the test sets the directory");
    fs::write(Path::new(&directory).join(name), content).expect("the test directory can be written");
}

fn die_by_kill() -> ! {
    note("died", []);
    raise(SIGKILL).expect("a process may kill itself");
    unreachable!("nobody survives SIGKILL")
}

/// The cases whose frame 1 goes on until somebody ends it.
const LONG: [&str; 4] = ["killed", "front-end killed", "front-end told to end", "launcher told to end"];

/// Draws two pictures per frame; the culprit misbehaves in frame 1.
struct Fake {
    backend: u32,
    width: u32,
    frame: u32,
    step: u64,
}

impl Fake {
    fn misbehave(&self) -> Result<(), DrawError> {
        if self.backend == CULPRIT && self.frame == 1 {
            match case().as_str() {
                "killed" => die_by_kill(),
                "panics" => panic!("a fake fault"),
                "errors" => return Err(DrawError("the fake device is lost; use another".to_owned())),
                "stuck" => thread::sleep(2 * CASE_LIMIT),
                "stopped" => raise(SIGSTOP).expect("a process may stop itself"),
                _ => {}
            }
        }
        Ok(())
    }

    fn steps(&self) -> u64 {
        if self.frame == 1 && LONG.contains(&case().as_str()) { 600 } else { 3 }
    }
}

impl Render for Fake {
    fn restart(&mut self, frame: &FrameState) -> Result<(), DrawError> {
        (self.frame, self.step) = (frame.index, 0);
        Ok(())
    }

    fn advance(&mut self, stop: StopAsked) -> Result<Advance, DrawError> {
        self.misbehave()?;
        let steps = self.steps();
        while self.step < steps && !stop() {
            self.step += 1;
            thread::sleep(Duration::from_millis(if steps > 3 { 100 } else { 0 }));
        }
        let report = (self.step == steps).then(|| Box::new(report(self.frame, self.backend)));
        Ok(Advance { done: self.step, total: 600, lacking_bricks: 0, report })
    }

    fn present(&mut self, sink: &mut dyn FnMut(ProjectorImage)) -> Result<(), DrawError> {
        if self.step < self.steps() {
            return Ok(());
        }
        for projector in [2 * self.backend, 2 * self.backend + 1] {
            let number = |i: u32| (i as f32 + 0.5) * (projector as f32 - 1.3) / (self.frame as f32 + 1.0);
            let (width, height) = (self.width, self.width * 3 / 4);
            let rgba = (0..4 * width * height).map(number).collect();
            sink(ProjectorImage { projector, width, height, rgba });
        }
        Ok(())
    }
    fn present_on_screens(&mut self, _: CodesAt, _: &mut dyn FnMut(ScreenPicture)) -> Result<(), DrawError> {
        Ok(())
    }
}

fn report(frame: u32, backend: u32) -> FrameReport {
    FrameReport {
        caster: protocol::Caster::Rays,
        frame,
        backend,
        projectors: vec![2 * backend, 2 * backend + 1],
        rays: 1,
        samples: 2,
        bricks_wanted: 3,
        bricks_resident: 4,
        bricks_loaded: 5,
        bytes_loaded: 6,
        working_set_union: 7,
        working_set_sum: Some(8),
        complete: true,
        shortfall: String::new(),
        upkeep: None,
        refined: None,
        damaged_bricks: 0,
        damaged: Vec::new(),
        stages: Stages::default(),
        total_ms: 0.25,
    }
}

pub fn open(setup: Setup) -> Result<Opened, String> {
    if case() == "opening fails" && setup.options.backend == CULPRIT {
        return Err("/no/such/head.lloom is not there; build it first".to_owned());
    }
    let text = |text: &str| text.to_owned();
    let info = DeviceInfo {
        adapter: text("fake"),
        reason: text("it is a test"),
        filter: text("exact"),
        cache_bytes: 1 << 20,
    };
    let Setup { options, .. } = setup;
    let fake = Fake { backend: options.backend, width: options.cache_bytes as u32, frame: 0, step: 0 };
    Ok(Opened::new(Box::new(fake), info))
}

fn setups(count: usize, width: u32) -> Vec<Setup> {
    let display = Display {
        name: "fake".to_owned(),
        width_m: 1.0,
        height_m: 1.0,
        pixel_size_m: 1e-3,
        angular_accuracy: 0.01,
        observer_in_display: DVec3::Z,
        eta: 1.0,
        rate_hz: 60.0,
        projectors: Vec::new(),
        adapters: Vec::new(),
    };
    let options = |backend| RendererOptions {
        backend,
        cache_bytes: width.into(),
        ..RendererOptions::in_process(display.clone(), vec![2 * backend, 2 * backend + 1])
    };
    let volume = || VolumeRef::Store("fake.lloom".into());
    let setup = |backend| Setup {
        options: options(backend),
        volume: volume(),
        trace: None,
        screens: Screens::default(),
        is_kept: false,
        held: None,
    };
    (0..count as u32).map(setup).collect()
}

fn frame(index: u32, knots: usize) -> FrameState {
    let points = (0..knots).map(|i| (i as f64 / knots as f64, 1.0)).collect();
    let optics = Optics::grey(Curve::new(points).expect("the points rise"));
    FrameState { index, ..FrameState::still(DVec3::Z, DAffine3::IDENTITY, optics) }
}

/// All that the front-end gets of two frames, as bytes: pictures by frame and projector, and reports.
pub fn two_frames(link: Box<dyn Link>) -> Result<Vec<u8>, Box<dyn Error>> {
    let count = link.backends();
    let limits = Limits { silence: Duration::from_secs(3), standstill: Duration::from_secs(4) };
    let width = if case() == "large pictures" { 1600 } else { 40 };
    let mut session = Session::start(link, setups(count, width), limits, Arc::default())?;
    let mut bytes = Vec::new();
    for index in 0..2 {
        let mut pictures = Vec::new();
        let reports = session.draw(&frame(index, 9), &mut |event| match event {
            RenderEvent::Image(image) => pictures.push(image),
            RenderEvent::Progress { .. } if index == 1 && case() == "front-end killed" => die_by_kill(),
            RenderEvent::Progress { .. } if index == 1 && case().ends_with("told to end") => {
                note("drawing", [])
            }
            RenderEvent::Progress { .. } => {}
        })?;
        pictures.sort_by_key(|image| image.projector);
        assert_eq!(pictures.len(), 2 * count, "each projector has one picture");
        let messages = pictures.into_iter().map(FromBackend::Image);
        let reports = reports.into_iter().map(|r| FromBackend::Done(Box::new(r)));
        messages.chain(reports).for_each(|m| bytes.extend(wire::encode(&m).expect("it came as bytes")));
        if case() == "front-end silent" {
            thread::sleep(CASE_LIMIT);
        }
    }
    session.finish()?;
    Ok(bytes)
}

pub fn be_frontend() -> ExitCode {
    note("front-end", process::id().to_string());
    let link = cluster::connect().unwrap_or_else(|error| fail("lightloom", &error.to_string()));
    match case().as_str() {
        "cost" => return cost(Box::new(link), 1, 400),
        "cost of pictures" => return cost(Box::new(link), 800, 20),
        "cost of a beat" => return cost_of_a_beat(Box::new(link)),
        _ => {}
    }
    let bytes = two_frames(Box::new(link)).unwrap_or_else(|error| fail("lightloom", &error.to_string()));
    note("bytes", bytes);
    ExitCode::SUCCESS
}

/// Prints what a frame costs whose pictures, two per back-end, are `width` pixels wide and no work to draw.
fn cost(link: Box<dyn Link>, width: u32, frames: u32) -> ExitCode {
    let count = link.backends();
    let mut session = Session::start(link, setups(count, width), Limits::default(), Arc::default())
        .expect("the back-ends start");
    let bytes = wire::encode(&FromFrontend::Frame(Box::new(frame(0, 40)))).expect("a frame");
    let mut times: Vec<Duration> = (0..frames)
        .map(|index| {
            let since = Instant::now();
            let state = frame(index, 40);
            session.draw(&state, &mut |_| {}).expect("a frame");
            since.elapsed()
        })
        .collect();
    times.sort();
    let [median, most] = [times[times.len() / 2], times[times.len() * 99 / 100]];
    let size = bytes.len();
    let text = format!(
        "a frame of {size} bytes to {count} ranks and back: median {median:?}, 99th percentile {most:?}"
    );
    session.finish().expect("the back-ends leave");
    note("cost", text);
    ExitCode::SUCCESS
}

/// Prints how long the front-end is at handing out the frame of a beat, of which nothing is to be drawn.
fn cost_of_a_beat(link: Box<dyn Link>) -> ExitCode {
    let (count, setups) = (link.backends(), setups(link.backends(), 1));
    let session = Session::start(link, setups.clone(), Limits::default(), Arc::default());
    let period = Duration::from_millis(100);
    let mut drive = Drive::new(session.expect("the back-ends start"), setups, period, Time::Real);
    let size = wire::encode(&FromFrontend::Beat { frame: Box::new(frame(0, 40)), newest: None })
        .expect("a frame")
        .len();
    let mut times = Vec::new();
    while times.len() < 100 {
        if let Happening::Due { frame: index, .. } = drive.await_next().expect("the beat goes on") {
            let state = frame(index, 40);
            let since = Instant::now();
            drive.draw(&state, None).expect("a frame");
            times.push(since.elapsed());
        }
    }
    times.sort();
    let [median, most] = [times[times.len() / 2], times[times.len() * 99 / 100]];
    let text = format!("{size} bytes to each of {count} ranks: median {median:?}, 99th percentile {most:?}");
    drive.finish().expect("the back-ends leave");
    note("cost", text);
    ExitCode::SUCCESS
}

pub fn be_worker() -> ExitCode {
    note(&format!("worker {}", process::id()), []);
    let silence = if case() == "front-end silent" { Duration::from_secs(2) } else { rank::FRONTEND_SILENCE };
    rank::work(open, silence)
}
