//! The transports against each other, and against lost processes: this program starts itself again under mpirun.

mod job;
mod ranks;

use job::{BACKENDS, CASE, FRONTEND, WORKERS, mpirun};
use ranks::{be_frontend, be_worker, open, two_frames};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs};
use transport::threads;

/// From the death of a back-end to the front-end's sentence as the launcher passes it on; it first waits over a second
/// for the ranks it ends.
const NOTICED_WITHIN: Duration = Duration::from_secs(3);

fn loses_a_back_end(has_recovery: bool) -> Result<String, String> {
    let run = mpirun("killed", &[FRONTEND, WORKERS], has_recovery);
    let line =
        run.failed_with(&["back-end 1 (rank 2, process ", " on host ", "ended while drawing frame 1"])?;
    let noticed = run.from_death_to_sentence.ok_or("nobody died")?;
    if noticed > NOTICED_WITHIN {
        return Err(format!("it was noticed after {noticed:?}:\n{}", run.text));
    }
    Ok(format!("said {noticed:?} after its death, all over after {:?}: {line}", run.was_over_soon()?))
}

fn loses_the_front_end(has_recovery: bool) -> Result<String, String> {
    let run = mpirun("front-end killed", &[FRONTEND, WORKERS], has_recovery);
    run.left_nobody()?;
    Ok(format!("all gone {:?} after its death", run.was_over_soon()?))
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
    ("a back-end that lives and gets no further", || {
        mpirun("stuck", &[FRONTEND, WORKERS], false)
            .failed_with(&["back-end 1 (rank 2", "got no further for 4 s"])
    }),
    ("a back-end whose process is stopped", || {
        mpirun("stopped", &[FRONTEND, WORKERS], false)
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
    ("a front-end that is asked to end", || {
        let run = mpirun("front-end told to end", &[FRONTEND, WORKERS], false);
        run.failed_with(&["ended the run (SIGTERM) while drawing frame 1"])
    }),
    ("a launcher that is asked to end", || {
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
];

/// Figures, which nothing can fail: printed where `--figures` asks for them, and not counted as tests.
const FIGURES: &[Case] = &[
    ("what a frame costs", || cost_by_mpi("cost")),
    ("what a frame with pictures of 800 × 600 costs", || cost_by_mpi("cost of pictures")),
    ("what the front-end spends on the messages of a beat", || {
        let run = mpirun("cost of a beat", &[FRONTEND, (36, "--worker")], false);
        fs::read_to_string(run.file("cost")).map_err(|_| run.text.clone())
    }),
];

fn print_figures() -> ExitCode {
    for (name, measure) in FIGURES {
        match measure() {
            Ok(figures) => println!("{name}: {figures}"),
            Err(why) => {
                println!("{name} cannot be measured: {why}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

fn main() -> ExitCode {
    match env::args().nth(1).as_deref() {
        Some("--frontend") => return be_frontend(),
        Some("--worker") => return be_worker(),
        Some("--figures") => return print_figures(),
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
