//! The transports against each other, and against lost processes: this program starts itself again under mpirun.

use backend::protocol::{
    DeviceChoice, DeviceInfo, FilterChoice, FrameReport, FrameState, ProjectorImage, Setup, Stages,
    VolumeRef, wire,
};
use backend::transport::*;
use display_config::Display;
use glam::{DAffine3, DVec3};
use shaders::optics::{Curve, ExtinctionUnit, Optics, Quality};
use signal_hook::{consts::SIGKILL, low_level::raise};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs, process, thread};

const BACKENDS: usize = 3;
const CULPRIT: u32 = 1;
const DIRECTORY: &str = "LIGHTLOOM_TEST_DIRECTORY";
const CASE: &str = "LIGHTLOOM_TEST_CASE";

/// From the death of a process to the end of the whole job; most of it is the launcher's own tidying.
const NOTICED_WITHIN: Duration = Duration::from_secs(4);

/// No case may take longer; each is killed then and has failed.
const CASE_LIMIT: Duration = Duration::from_secs(40);

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

// ---- What the ranks do ----

/// The cases whose frame 1 goes on until somebody ends it.
const LONG: [&str; 4] = ["killed", "front-end killed", "front-end told to end", "launcher told to end"];

/// Draws two pictures per frame; the culprit misbehaves in frame 1.
struct Fake {
    backend: u32,
    width: u32,
}

impl Draw for Fake {
    fn draw(&mut self, frame: &FrameState, sink: &mut dyn FnMut(DrawEvent)) -> Result<FrameReport, String> {
        if self.backend == CULPRIT && frame.index == 1 {
            match case().as_str() {
                "killed" => die_by_kill(),
                "panics" => panic!("a fake fault"),
                "errors" => return Err("the fake device is lost; use another".to_owned()),
                "silent" => thread::sleep(2 * CASE_LIMIT),
                _ => {}
            }
        }
        let is_long = frame.index == 1 && LONG.contains(&case().as_str());
        for step in 0..if is_long { 600 } else { 3 } {
            sink(DrawEvent::Progress { done: step, total: 600 });
            thread::sleep(Duration::from_millis(if is_long { 100 } else { 0 }));
        }
        for projector in [2 * self.backend, 2 * self.backend + 1] {
            let number = |i: u32| (i as f32 + 0.5) * (projector as f32 - 1.3) / (frame.index as f32 + 1.0);
            let (width, height) = (self.width, self.width * 3 / 4);
            let rgba = (0..4 * width * height).map(number).collect();
            sink(DrawEvent::Image(ProjectorImage { projector, width, height, rgba }));
        }
        Ok(report(frame.index, self.backend))
    }
}

fn report(frame: u32, backend: u32) -> FrameReport {
    FrameReport {
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
        working_set_sum: 8,
        complete: true,
        shortfall: String::new(),
        stages: Stages::default(),
        total_ms: 0.25,
    }
}

fn open(setup: Setup) -> Result<Opened, String> {
    if case() == "opening fails" && setup.backend == CULPRIT {
        return Err("/no/such/head.lloom is not there; build it first".to_owned());
    }
    let text = |text: &str| text.to_owned();
    let info = DeviceInfo { adapter: text("fake"), reason: text("it is a test"), filter: text("exact") };
    Ok((Box::new(Fake { backend: setup.backend, width: setup.cache_bytes as u32 }), info))
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
        projectors: Vec::new(),
    };
    let setup = |backend| Setup {
        display: display.clone(),
        projectors: vec![2 * backend, 2 * backend + 1],
        backend,
        volume: VolumeRef::Store("fake.lloom".into()),
        device: DeviceChoice::Cpu,
        filter: FilterChoice::Exact,
        cache_bytes: width.into(),
    };
    (0..count as u32).map(setup).collect()
}

fn frame(index: u32, knots: usize) -> FrameState {
    let points = (0..knots).map(|i| (i as f64 / knots as f64, 1.0)).collect();
    FrameState {
        index,
        time_s: 0.0,
        observer_in_display: DVec3::Z,
        eta: 1.0,
        display_from_volume: DAffine3::IDENTITY,
        optics: Optics {
            domain: (0.0, 1.0),
            extinction: Curve::new(points).expect("the points rise"),
            extinction_unit: ExtinctionUnit::PerMetre,
            colour: Curve::constant(DVec3::ONE),
            mimda: None,
        },
        light: None,
        quality: Quality::default(),
        tool: None,
    }
}

/// All that the front-end gets of two frames, as bytes: pictures by frame and projector, and reports.
fn two_frames(link: Box<dyn Link>) -> Result<Vec<u8>, SessionError> {
    let count = link.backends();
    let limits = Limits { opening: Duration::from_secs(10), drawing: Duration::from_secs(3) };
    let width = if case() == "large pictures" { 1600 } else { 40 };
    let mut session = Session::start(link, setups(count, width), limits)?;
    let mut bytes = Vec::new();
    for index in 0..2 {
        let mut pictures = Vec::new();
        let reports = session.render(&frame(index, 9), &mut |event| match event.kind {
            EventKind::Image(image) => pictures.push(image),
            EventKind::Progress { .. } if index == 1 && case() == "front-end killed" => die_by_kill(),
            EventKind::Progress { .. } => {}
        })?;
        pictures.sort_by_key(|image| image.projector);
        assert_eq!(pictures.len(), 2 * count, "each projector has one picture");
        let messages = pictures.into_iter().map(backend::protocol::FromBackend::Image);
        let reports = reports.into_iter().map(|r| backend::protocol::FromBackend::Done(Box::new(r)));
        messages.chain(reports).for_each(|m| bytes.extend(wire::encode(&m).expect("it came as bytes")));
        if case() == "front-end silent" {
            thread::sleep(CASE_LIMIT);
        }
    }
    session.finish()?;
    Ok(bytes)
}

fn be_frontend() -> ExitCode {
    note("front-end", process::id().to_string());
    let link = cluster::connect().unwrap_or_else(|error| fail("lightloom", &error.to_string()));
    match case().as_str() {
        "cost" => return cost(Box::new(link), 1, 400),
        "cost of pictures" => return cost(Box::new(link), 800, 20),
        _ => {}
    }
    let bytes = two_frames(Box::new(link)).unwrap_or_else(|error| fail("lightloom", &error.to_string()));
    note("bytes", bytes);
    ExitCode::SUCCESS
}

/// Prints what a frame costs whose pictures, two per back-end, are `width` pixels wide and no work to draw.
fn cost(link: Box<dyn Link>, width: u32, frames: u32) -> ExitCode {
    let count = link.backends();
    let mut session =
        Session::start(link, setups(count, width), Limits::default()).expect("the back-ends start");
    let bytes =
        wire::encode(&backend::protocol::FromFrontend::Frame(Box::new(frame(0, 40)))).expect("a frame");
    let mut times: Vec<Duration> = (0..frames)
        .map(|index| {
            let since = Instant::now();
            let state = frame(index, 40);
            session.render(&state, &mut |_| {}).expect("a frame");
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

fn be_worker() -> ExitCode {
    note(&format!("worker {}", process::id()), []);
    let silence =
        if case() == "front-end silent" { Duration::from_secs(2) } else { cluster::FRONTEND_SILENCE };
    cluster::work(open, silence)
}

// ---- The test of them ----

struct Run {
    directory: tempfile::TempDir,
    code: Option<i32>,
    has_recovery: bool,
    text: String,
    since_death: Option<Duration>,
}

const FRONTEND: (usize, &str) = (1, "--frontend");
const WORKERS: (usize, &str) = (BACKENDS, "--worker");

/// Runs groups of (ranks, role) as one job until it ends or its time is up.
fn mpirun(case: &str, groups: &[(usize, &str)], has_recovery: bool) -> Run {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let output = |name: &str| fs::File::create(directory.path().join(name)).expect("a file");
    let mut command = Command::new("mpirun");
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.env("OMPI_MCA_btl_vader_single_copy_mechanism", "none");
    command.env(CASE, case).env(DIRECTORY, directory.path()).arg("--oversubscribe");
    command.args(if has_recovery { ["--enable-recovery"].as_slice() } else { &[] });
    for (index, (ranks, role)) in groups.iter().enumerate() {
        command.args(if index > 0 { [":"].as_slice() } else { &[] });
        command.arg("-n").arg(ranks.to_string()).arg(env::current_exe().expect("this program")).arg(role);
    }
    command.stdin(Stdio::null()).stdout(output("stdout")).stderr(output("stderr"));
    let job = command.spawn().expect("mpirun starts");
    let ended = wait(job, case, directory.path());
    let read = |name: &str| fs::read_to_string(directory.path().join(name)).unwrap_or_default();
    let died = fs::metadata(directory.path().join("died")).and_then(|file| file.modified()).ok();
    let since_death = died.and_then(|at| SystemTime::now().duration_since(at).ok());
    let text = read("stdout") + &read("stderr");
    Run { directory, code: ended.and_then(|status| status.code()), has_recovery, text, since_death }
}

/// How the job ended; None when its time was up.
fn wait(mut job: Child, case: &str, directory: &Path) -> Option<ExitStatus> {
    let since = Instant::now();
    let mut to_tell = match case {
        "launcher told to end" => Some(job.id().to_string()),
        _ => None,
    };
    while since.elapsed() < CASE_LIMIT {
        if let Some(status) = job.try_wait().expect("mpirun can be waited for") {
            return Some(status);
        }
        if case == "front-end told to end" && to_tell.is_none() {
            to_tell = fs::read_to_string(directory.join("front-end")).ok().filter(|text| !text.is_empty());
        }
        if since.elapsed() > Duration::from_secs(2)
            && fs::exists(directory.join("told")).is_ok_and(|told| !told)
            && let Some(process) = &to_tell
        {
            fs::write(directory.join("told"), []).expect("a file");
            let _ = Command::new("kill").arg(process).status();
        }
        thread::sleep(Duration::from_millis(10));
    }
    job.kill().expect("mpirun can be killed");
    job.wait().expect("mpirun can be waited for");
    None
}

impl Run {
    fn file(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn sentences(&self) -> usize {
        self.text.lines().filter(|line| line.starts_with("lightloom: ")).count()
    }

    /// It ended by itself, unsuccessfully, with one sentence that has `parts` in it, and left no process behind.
    fn failed_with(&self, parts: &[&str]) -> Result<String, String> {
        // With recovery on, Open MPI's launcher reports success whatever a rank's exit code is.
        if self.code.is_none_or(|code| code == 0 && !self.has_recovery) {
            return Err(format!("exit code {:?}:\n{}", self.code, self.text));
        }
        let line = self.text.lines().find(|line| line.starts_with("lightloom"));
        let line = line.ok_or_else(|| format!("no sentence in:\n{}", self.text))?;
        match parts.iter().find(|part| !line.contains(**part)) {
            Some(part) => return Err(format!("no \"{part}\" in:\n{}", self.text)),
            None if self.sentences() > 1 => return Err(format!("several sentences in:\n{}", self.text)),
            None => {}
        }
        self.left_nobody()?;
        Ok(line.to_owned())
    }

    /// A back-end may stay for a moment after the launcher has gone.
    fn left_nobody(&self) -> Result<(), String> {
        let since = Instant::now();
        while let Some(worker) = self.worker_left() {
            if since.elapsed() > NOTICED_WITHIN {
                return Err(format!("process {worker} is still there:\n{}", self.text));
            }
            thread::sleep(Duration::from_millis(20));
        }
        Ok(())
    }

    fn worker_left(&self) -> Option<String> {
        let entries = fs::read_dir(self.directory.path()).expect("the test directory").flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut workers = names.filter_map(|name| name.strip_prefix("worker ").map(str::to_owned));
        let command_line =
            |worker: &str| fs::read_to_string(format!("/proc/{worker}/cmdline")).unwrap_or_default();
        workers.find(|worker| command_line(worker).contains("--worker"))
    }

    fn noticed_soon(&self) -> Result<Duration, String> {
        let took = self.since_death.ok_or("nobody died")?;
        if took < NOTICED_WITHIN { Ok(took) } else { Err(format!("it took {took:?}:\n{}", self.text)) }
    }
}

fn loses_a_back_end(recovery: bool) -> Result<String, String> {
    let run = mpirun("killed", &[FRONTEND, WORKERS], recovery);
    let line =
        run.failed_with(&["back-end 1 (rank 2, process ", " on host ", "ended while drawing frame 1"])?;
    Ok(format!("{:?} after its death: {line}", run.noticed_soon()?))
}

fn loses_the_front_end(recovery: bool) -> Result<String, String> {
    let run = mpirun("front-end killed", &[FRONTEND, WORKERS], recovery);
    run.left_nobody()?;
    Ok(format!("all gone {:?} after its death", run.noticed_soon()?))
}

fn same_bytes(case: &str) -> Result<String, String> {
    // SAFETY: the cases run one after another on the only thread that reads or writes the environment.
    unsafe { env::set_var(CASE, case) };
    let link = threads::spawn(BACKENDS, open).map_err(|error| error.to_string())?;
    let by_threads = two_frames(Box::new(link)).map_err(|error| error.to_string())?;
    let since = Instant::now();
    let run = mpirun(case, &[FRONTEND, WORKERS], false);
    let by_mpi = fs::read(run.file("bytes")).map_err(|error| format!("{error}:\n{}", run.text))?;
    match (run.code, by_mpi == by_threads) {
        (Some(0), true) => Ok(format!("{} bytes; the job took {:?}", by_mpi.len(), since.elapsed())),
        (code, equal) => Err(format!("exit code {code:?}, equal bytes: {equal}:\n{}", run.text)),
    }
}

fn cost_by_mpi(case: &str) -> Result<String, String> {
    let run = mpirun(case, &[FRONTEND, (4, "--worker")], false);
    fs::read_to_string(run.file("cost")).map_err(|_| run.text.clone())
}

type Case = (&'static str, fn() -> Result<String, String>);

const CASES: &[Case] = &[
    ("the same bytes by threads and by MPI", || same_bytes("")),
    ("the same large pictures by threads and by MPI", || same_bytes("large pictures")),
    ("a killed back-end", || loses_a_back_end(false)),
    ("a killed back-end, the launcher goes on", || loses_a_back_end(true)),
    ("a killed front-end", || loses_the_front_end(false)),
    ("a killed front-end, the launcher goes on", || loses_the_front_end(true)),
    ("a back-end that panics", || {
        mpirun("panics", &[FRONTEND, WORKERS], false)
            .failed_with(&["back-end 1 (rank 2", "panicked: a fake fault"])
    }),
    ("a back-end that errs", || {
        mpirun("errors", &[FRONTEND, WORKERS], false)
            .failed_with(&["back-end 1 (rank 2", "the fake device is lost"])
    }),
    ("a back-end that cannot open its volume", || {
        let run = mpirun("opening fails", &[FRONTEND, WORKERS], false);
        run.failed_with(&["back-end 1 (rank 2", "while opening its volume", "/no/such/head.lloom"])
    }),
    ("a back-end that lives and is silent", || {
        mpirun("silent", &[FRONTEND, WORKERS], false)
            .failed_with(&["back-end 1 (rank 2", "said nothing for 3 s"])
    }),
    ("a front-end that lives and is silent", || {
        let run = mpirun("front-end silent", &[FRONTEND, WORKERS], false);
        let said = run
            .text
            .lines()
            .find(|line| line.contains("lightloom-backend: the front-end has said nothing for 2 s"));
        run.left_nobody()?;
        said.map(str::to_owned).ok_or_else(|| run.text.clone())
    }),
    ("a front-end that is told to end", || {
        let run = mpirun("front-end told to end", &[FRONTEND, WORKERS], false);
        run.failed_with(&["ended the run (SIGTERM) while drawing frame 1"])
    }),
    ("a launcher that is told to end", || {
        let run = mpirun("launcher told to end", &[FRONTEND, WORKERS], false);
        run.left_nobody()?;
        if run.code == Some(0) { Err(run.text) } else { Ok(format!("exit code {:?}", run.code)) }
    }),
    ("several front-ends", || {
        mpirun("", &[(3, "--frontend")], false).failed_with(&["both a front-end", "mpirun -n 1"])
    }),
    ("no front-end", || mpirun("", &[(3, "--worker")], false).failed_with(&["rank 0 must be the front-end"])),
    ("no back-end", || mpirun("", &[(1, "--frontend")], false).failed_with(&["no back-end was started"])),
    ("a back-end without a launcher", || {
        let output =
            Command::new(env!("CARGO_BIN_EXE_lightloom-backend")).output().map_err(|e| e.to_string())?;
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.code() == Some(2) && said.contains("mpirun -n 1") { Ok(said) } else { Err(said) }
    }),
    ("what a frame costs", || cost_by_mpi("cost")),
    ("what a frame with pictures of 800 × 600 costs", || cost_by_mpi("cost of pictures")),
];

fn main() -> ExitCode {
    match env::args().nth(1).as_deref() {
        Some("--frontend") => return be_frontend(),
        Some("--worker") => return be_worker(),
        _ => {}
    }
    if Command::new("mpirun").arg("--version").stdout(Stdio::null()).status().is_err() {
        println!("mpi_link: skipped, there is no mpirun on the path; 0 passed, 0 failed");
        let is_required = env::var("LIGHTLOOM_REQUIRE_MPI").is_ok_and(|value| value == "1");
        return if is_required { ExitCode::FAILURE } else { ExitCode::SUCCESS };
    }
    let wanted = env::args().nth(1).filter(|argument| !argument.starts_with('-')).unwrap_or_default();
    let (mut passed, mut failed) = (0, 0);
    for (name, case) in CASES.iter().filter(|(name, _)| name.contains(&wanted)) {
        match case() {
            Ok(said) => {
                passed += 1;
                println!("ok: {name}: {said}");
            }
            Err(why) => {
                failed += 1;
                println!("FAILED: {name}: {why}");
            }
        }
    }
    println!("{passed} passed, {failed} failed");
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
