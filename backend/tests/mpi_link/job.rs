//! One job under mpirun, and what became of it.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs, thread};

pub const BACKENDS: usize = 3;
pub const DIRECTORY: &str = "LIGHTLOOM_TEST_DIRECTORY";
pub const CASE: &str = "LIGHTLOOM_TEST_CASE";

/// From the death of a process to the end of all others. Most of it is the launcher's own tidying, which waits
/// some seconds for ranks that do not end at once.
const OVER_WITHIN: Duration = Duration::from_secs(8);

/// No case may take longer; each is killed then and has failed.
pub const CASE_LIMIT: Duration = Duration::from_secs(40);

pub struct Run {
    directory: tempfile::TempDir,
    pub code: Option<i32>,
    has_recovery: bool,
    pub text: String,
    pub from_death_to_sentence: Option<Duration>,
    pub from_death_to_end: Option<Duration>,
}

pub const FRONTEND: (usize, &str) = (1, "--frontend");
pub const WORKERS: (usize, &str) = (BACKENDS, "--worker");

/// Runs groups of (ranks, role) as one job until it ends or its time is up.
pub fn mpirun(case: &str, groups: &[(usize, &str)], has_recovery: bool) -> Run {
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
    let (ended, said_at) = wait(job, case, directory.path());
    let read = |name: &str| fs::read_to_string(directory.path().join(name)).unwrap_or_default();
    let died = fs::metadata(directory.path().join("died")).and_then(|file| file.modified()).ok();
    let after_death = |at: SystemTime| died.and_then(|died| at.duration_since(died).ok());
    let from_death_to_end = after_death(SystemTime::now());
    let from_death_to_sentence = said_at.and_then(after_death);
    let text = read("stdout") + &read("stderr");
    Run {
        directory,
        code: ended.and_then(|status| status.code()),
        has_recovery,
        text,
        from_death_to_sentence,
        from_death_to_end,
    }
}

/// How the job ended, None when its time was up; and when the front-end said why.
fn wait(mut job: Child, case: &str, directory: &Path) -> (Option<ExitStatus>, Option<SystemTime>) {
    let since = Instant::now();
    let mut said_at = None;
    let mut is_to_tell = case.ends_with("told to end");
    while since.elapsed() < CASE_LIMIT {
        let said = fs::read_to_string(directory.join("stderr")).unwrap_or_default();
        if said_at.is_none() && said.lines().any(|line| line.starts_with("lightloom: ")) {
            said_at = Some(SystemTime::now());
        }
        if let Some(status) = job.try_wait().expect("mpirun can be waited for") {
            return (Some(status), said_at);
        }
        // Frame 1 goes on until somebody ends it.
        if is_to_tell && fs::exists(directory.join("drawing")).is_ok_and(|is_there| is_there) {
            is_to_tell = false;
            let process = match case {
                "launcher told to end" => job.id().to_string(),
                _ => fs::read_to_string(directory.join("front-end")).expect("it said which process it is"),
            };
            let _ = Command::new("kill").arg(process).status();
        }
        thread::sleep(Duration::from_millis(10));
    }
    job.kill().expect("mpirun can be killed");
    job.wait().expect("mpirun can be waited for");
    (None, said_at)
}

impl Run {
    pub fn file(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn sentences(&self) -> usize {
        self.text.lines().filter(|line| line.starts_with("lightloom: ")).count()
    }

    /// It ended by itself, unsuccessfully, with one sentence that has `parts` in it, and left no process behind.
    pub fn failed_with(&self, parts: &[&str]) -> Result<String, String> {
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
    pub fn left_nobody(&self) -> Result<(), String> {
        let since = Instant::now();
        while let Some(worker) = self.worker_left() {
            if since.elapsed() > OVER_WITHIN {
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

    pub fn was_over_soon(&self) -> Result<Duration, String> {
        let took = self.from_death_to_end.ok_or("nobody died")?;
        if took < OVER_WITHIN { Ok(took) } else { Err(format!("the end took {took:?}:\n{}", self.text)) }
    }
}
