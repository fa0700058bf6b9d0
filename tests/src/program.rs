//! The real programs, run as a user would run them: nothing here may hang.

use crate::machine;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{Read, Seek};
use std::os::unix::fs::FileExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longer than any run of these tests takes on two busy cores; a run that takes longer hangs.
pub const LIMIT: Duration = Duration::from_secs(120);

/// How often a running program is looked at.
const LOOK_INTERVAL: Duration = Duration::from_millis(10);

/// Four projectors of 96 × 72 pixels before the desk: a picture in a moment, also on the CPU.
pub const SMALL_DISPLAY: &str = "\
name = \"small4\"
screen_width_m = 0.60
screen_height_m = 0.45
pixel_size_m = 0.00625
angular_accuracy_deg = 9.0
observer_m = [0.0, 0.0, 1.2]
eta = 1.0

[projector_line]
count = 4
from_m = [-0.36, 0.0, -1.5]
to_m = [0.36, 0.0, -1.5]
width_px = 96
height_px = 72
covers = \"screen\"
backends = 2
";

/// A scene of skins over a volume; a test says how it stands, and what else it needs.
pub fn scene_of_skins(volume: &str, more: &str) -> String {
    format!(
        "\
[volume]
source = '{volume}'
[optics]
domain = [0.0, 1.0]
extinction_unit = 'per_metre'
extinction = [[0.3, 0], [0.5, 20], [1.0, 40]]
colour = [[0.3, 0.1, 0.5, 0.9], [1.0, 0.9, 0.6, 0.2]]
{more}"
    )
}

/// Writes the small display into a folder.
pub fn small_display(folder: &Path) -> String {
    let path = folder.join("small4.toml");
    fs::write(&path, SMALL_DISPLAY).expect("a temporary folder can be written");
    path.to_string_lossy().into_owned()
}

/// A file of the test data.
pub fn test_data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name).to_string_lossy().into_owned()
}

/// Frames that back-ends have shown late, by the report of a show's beat.
pub fn late_frames(beat: &Value) -> u64 {
    beat["backends"].as_array().into_iter().flatten().filter_map(|one| one["late"].as_u64()).sum()
}

/// `lightloom` with arguments.
pub fn lightloom<S: AsRef<str>>(arguments: &[S]) -> Command {
    let mut command = Command::new(folder_of_programs().join("lightloom"));
    command.args(arguments.iter().map(AsRef::as_ref));
    command
}

/// `lightloom` with arguments as rank 0, and so many back-ends as further ranks. None where there is no mpirun or no
/// MPI in this build, which is said aloud, and a failure with LIGHTLOOM_REQUIRE_MPI=1.
pub fn cluster<S: AsRef<str>>(arguments: &[S], backends: u32) -> Option<Command> {
    if !has_mpi() {
        return None;
    }
    let programs = folder_of_programs();
    let mut command = Command::new("mpirun");
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.env("OMPI_MCA_btl_vader_single_copy_mechanism", "none");
    command.args(["--oversubscribe", "-n", "1"]).arg(programs.join("lightloom"));
    command.args(arguments.iter().map(AsRef::as_ref));
    command.args([":", "-n"]).arg(backends.to_string()).arg(programs.join("lightloom-backend"));
    Some(command)
}

fn has_mpi() -> bool {
    let lack = match Command::new("mpirun").arg("--version").stdout(Stdio::null()).status() {
        Err(_) => "there is no mpirun on the path",
        Ok(_) if !cfg!(feature = "mpi") => "these tests were built without the feature mpi",
        Ok(_) => return true,
    };
    skip(lack, "LIGHTLOOM_REQUIRE_MPI");
    false
}

/// Whether the programs find a Vulkan driver here; the lack of one is said aloud, and a failure with
/// LIGHTLOOM_REQUIRE_GPU=1.
pub fn has_gpu() -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let out = folder.path().join("out").to_string_lossy().into_owned();
    let display = small_display(folder.path());
    let tiny = ["simulate", "procedural:shells@16", "--device", "gpu", "--display", &display, "--out", &out];
    let ran = run(&mut lightloom(&tiny));
    match ran.stderr.lines().find(|line| line.contains("--device cpu")) {
        None => true,
        Some(lack) => {
            skip(lack, "LIGHTLOOM_REQUIRE_GPU");
            false
        }
    }
}

/// Says aloud that something is skipped; a failure where the environment forbids it.
fn skip(lack: &str, requirement: &str) {
    println!("SKIPPED: {lack}");
    assert!(std::env::var(requirement).as_deref() != Ok("1"), "{requirement}=1, and {lack}");
}

/// Names the folder with `lightloom` and `lightloom-backend`, built with the features of these tests. `tests/run` sets it;
/// without it the programs are built here.
pub const PROGRAMS: &str = "LIGHTLOOM_PROGRAMS";

/// The folder with both programs.
fn folder_of_programs() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| std::env::var_os(PROGRAMS).map_or_else(|| keep(&build()), given))
}

/// The folder that somebody else has filled.
fn given(folder: OsString) -> PathBuf {
    let folder = PathBuf::from(folder);
    let program = folder.join("lightloom");
    assert!(program.is_file(), "{PROGRAMS} is {}, and there is no lightloom in it", folder.display());
    folder
}

/// Builds the programs with the features of these tests, and returns where cargo put them. Always optimised, whatever
/// the tests are: the programs cast millions of rays.
fn build() -> Vec<PathBuf> {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    command.args(["build", "--release", "--message-format=json", "-p", "frontend", "-p", "backend"]);
    command.args(if cfg!(feature = "gpu") { &[][..] } else { &["--no-default-features"] });
    command.args(if cfg!(feature = "mpi") { &["--features", "frontend/mpi,backend/mpi"][..] } else { &[] });
    let output = command.stderr(Stdio::inherit()).output().expect("cargo starts");
    assert!(output.status.success(), "the programs do not build");
    let messages = String::from_utf8_lossy(&output.stdout).into_owned();
    let executable = |line: &str| {
        let message: Value = serde_json::from_str(line).ok()?;
        message["executable"].as_str().map(PathBuf::from)
    };
    messages.lines().filter_map(executable).collect()
}

/// Puts the programs into a folder of this source tree's own: builds of other trees and features may share the target
/// folder, and would put theirs in the place of these while the tests run.
fn keep(programs: &[PathBuf]) -> PathBuf {
    let target = programs.first().and_then(|program| program.parent()).expect("cargo names the programs");
    let features = u8::from(cfg!(feature = "gpu")) + 2 * u8::from(cfg!(feature = "mpi"));
    let tree = env!("CARGO_MANIFEST_DIR").replace(['/', '\\'], "_");
    let folder = target.join("programs-under-test").join(format!("{tree}-{features}"));
    fs::create_dir_all(&folder).expect("the target folder can be written");
    for program in programs {
        let name = program.file_name().expect("a program has a name");
        // Under its name at once and whole: another test binary may be running the one before it.
        let part = folder.join(format!("{}.{}", name.to_string_lossy(), std::process::id()));
        fs::copy(program, &part).expect("a program just built can be copied");
        fs::rename(&part, folder.join(name)).expect("a file can be renamed in its folder");
    }
    folder
}

/// How a program ended and what it said.
#[derive(Debug)]
pub struct Ran {
    /// Exit code; None where a signal ended it.
    pub code: Option<i32>,
    /// All of its standard output.
    pub stdout: String,
    /// All of its standard error.
    pub stderr: String,
}

/// A program that runs. It is killed with all that it started when this is dropped.
pub struct Running {
    child: Child,
    started: Instant,
    stdout: File,
    stderr: File,
    is_over: bool,
}

/// Runs a program to its end; the test fails where it takes longer than [`LIMIT`].
pub fn run(command: &mut Command) -> Ran {
    start(command).finish(LIMIT)
}

/// Starts a program as the head of a process group of its own, once no test has the machine alone.
pub fn start(command: &mut Command) -> Running {
    machine::beside_others();
    let output = || tempfile::tempfile().expect("a temporary file can be made");
    let (stdout, stderr) = (output(), output());
    let for_child = |file: &File| file.try_clone().expect("a file handle can be had twice");
    command.stdin(Stdio::null()).stdout(for_child(&stdout)).stderr(for_child(&stderr)).process_group(0);
    let child = command.spawn().expect("the program starts");
    Running { child, started: Instant::now(), stdout, stderr, is_over: false }
}

impl Running {
    /// Its process number.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Interrupts it, as Ctrl-C does; the test fails where it has ended by itself.
    pub fn interrupt(&self) {
        let sent = Command::new("kill").args(["-INT", &self.process().to_string()]).status();
        assert!(sent.is_ok_and(|status| status.success()), "it had ended by itself");
    }

    /// Waits for its end; the test fails where that is not within `limit` of its start.
    pub fn finish(mut self, limit: Duration) -> Ran {
        let status = self.wait(limit);
        let (stdout, stderr) = (text(&mut self.stdout), text(&mut self.stderr));
        match status {
            Some(status) => Ran { code: status.code(), stdout, stderr },
            None => panic!("it has not ended after {limit:?}; it said:\n{stdout}{stderr}"),
        }
    }

    fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        while self.started.elapsed() < limit {
            if let Some(status) = self.child.try_wait().expect("a child can be waited for") {
                self.is_over = true;
                return Some(status);
            }
            sleep(LOOK_INTERVAL);
        }
        None
    }

    /// Waits until it has said something on its standard error.
    #[track_caller]
    pub fn wait_to_say(&self, what: &str) {
        // Without moving the place in the file, which it shares with the program.
        let said = || -> std::io::Result<Vec<u8>> {
            let mut bytes = vec![0; self.stderr.metadata()?.len() as usize];
            self.stderr.read_exact_at(&mut bytes, 0)?;
            Ok(bytes)
        };
        let has_said = || String::from_utf8_lossy(&said().expect("the file can be read")).contains(what);
        machine::wait_for(what, has_said);
    }

    /// How long it has been running.
    pub fn age(&self) -> Duration {
        self.started.elapsed()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !self.is_over {
            // The launcher takes its ranks along when it is asked to end; what stays is killed.
            let _ = Command::new("kill").arg(self.child.id().to_string()).status();
            sleep(Duration::from_secs(2));
            let _ = Command::new("kill").args(["-9", "--", &format!("-{}", self.child.id())]).status();
            let _ = self.child.wait();
        }
    }
}

fn text(file: &mut File) -> String {
    let mut bytes = Vec::new();
    file.rewind().and_then(|()| file.read_to_end(&mut bytes)).expect("a temporary file can be read");
    String::from_utf8_lossy(&bytes).into_owned()
}

impl Ran {
    /// Fails the test unless the program ended well.
    #[track_caller]
    pub fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "{}{}", self.stdout, self.stderr);
        self
    }

    /// Fails the test unless the program refused: an exit code of its own above 0, one sentence with all of `parts`,
    /// no panic, nothing on standard output.
    #[track_caller]
    pub fn refused(&self, parts: &[&str]) {
        let sentences: Vec<_> = self.stderr.lines().filter(|line| line.starts_with("lightloom:")).collect();
        let [sentence] = sentences[..] else { panic!("not one sentence: {self:?}") };
        for part in parts {
            assert!(sentence.contains(part), "no `{part}` in: {sentence}");
        }
        // 101 is what a panic ends with.
        assert!(self.code.is_some_and(|code| code != 0 && code != 101), "{self:?}");
        assert!(!self.stderr.contains("panicked") && !self.stderr.contains("RUST_BACKTRACE"), "{self:?}");
        assert_eq!(self.stdout, "", "{self:?}");
    }
}

/// All files below a folder with their bytes, by their paths from there; none where the folder is not there.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, fs::read(&path).expect("a file of the run can be read"));
        }
    }
    found
}

/// Pictures by their names, as bytes.
pub type Pictures = BTreeMap<String, Vec<u8>>;

/// The pictures below a folder with their bytes: all but the reports, which tell of times.
pub fn pictures(folder: &Path) -> Pictures {
    let mut found = files(folder);
    found.retain(|name, _| name.ends_with(".png") || name.ends_with(".exr"));
    found
}

/// Fails the test, by name, where two runs did not write the same pictures byte for byte.
#[track_caller]
pub fn assert_same(what: &str, one: &Pictures, other: &Pictures) {
    assert!(one.keys().eq(other.keys()), "{what}: {:?} and {:?}", one.keys(), other.keys());
    assert!(!one.is_empty(), "{what}: there are no pictures");
    let differ: Vec<_> = one.keys().filter(|name| one[*name] != other[*name]).collect();
    assert!(differ.is_empty(), "{what}: {differ:?} differ");
}

/// The report of a run.
#[track_caller]
pub fn report(out: &Path) -> Value {
    let text = fs::read_to_string(out.join("report.json")).expect("the run wrote its report");
    serde_json::from_str(&text).expect("the report is JSON")
}
