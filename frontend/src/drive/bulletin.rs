//! How an exhibit goes, for those who look after it: a log, and a file with the state of things.

use super::{BeatSummary, Recorder};
use crate::FrontendError;
use crate::staging::Theatre;
use exhibit::{InputStatus, Log, LogLimits, State, Status, StatusFile, time_text};
use protocol::FrameState;
use renderer::output::OutputError;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use world::{Moment, Phase};

/// Troubles that the state tells.
const MOST_TROUBLES: usize = 10;

/// A log and a state, each if it is wanted.
pub struct Bulletin {
    log: Option<Log>,
    file: Option<StatusFile>,
    status: Status,
    /// A file on the disk whose space is watched.
    disk: Option<PathBuf>,
    troubles: VecDeque<String>,
    item: Option<usize>,
    /// The laws that the world was against in the frame before.
    faults: Vec<&'static str>,
    /// Whether the state could not be written last time.
    is_stuck: bool,
    news: Vec<String>,
}

impl Bulletin {
    /// Begins both.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn open(
        title: &str,
        status: Option<&Path>,
        log: Option<&Path>,
        disk: Option<PathBuf>,
    ) -> Result<Self, FrontendError> {
        let opened = log.map(|path| {
            Log::open(path, LogLimits::default())
                .map_err(|source| OutputError::Write { path: path.to_owned(), source })
        });
        Ok(Self {
            log: opened.transpose()?,
            file: status.map(StatusFile::new),
            status: Status::starting(title, env!("CARGO_PKG_VERSION"), SystemTime::now()),
            disk,
            troubles: VecDeque::new(),
            item: None,
            faults: Vec::new(),
            is_stuck: false,
            news: Vec::new(),
        })
    }

    /// Where the exhibit is, from now on.
    pub fn state(&mut self, state: State) {
        let name = match state {
            State::Starting => "it starts",
            State::Open => "visitors do things",
            State::Attract => "nobody is there: the attract loop begins",
            State::Ended => "it has ended",
            State::Failed => "it could not go on",
        };
        if self.status.state != state || state == State::Starting {
            self.status.state = state;
            self.note(name);
        }
        self.write(SystemTime::now());
    }

    /// Writes a sentence into the log.
    pub fn note(&mut self, sentence: &str) {
        let is_stuck = self.log.as_mut().is_some_and(|log| log.say(SystemTime::now(), sentence));
        if is_stuck {
            self.news.push("the log cannot be written; is its disk full?".to_owned());
        }
    }

    fn write(&mut self, now: SystemTime) {
        self.status.written = time_text(now);
        self.status.troubles = self.troubles.iter().cloned().collect();
        let Usage { memory_mb, open_files } = usage();
        (self.status.memory_mb, self.status.open_files) = (memory_mb, open_files);
        self.status.disk_mb = self.disk.as_deref().and_then(free_mb);
        let written = self.file.as_mut().map_or(Ok(()), |file| file.write(now, &self.status));
        if written.is_err() && !self.is_stuck {
            self.news.push("the state cannot be written; is its disk full?".to_owned());
        }
        self.is_stuck = written.is_err();
    }
}

impl Recorder for Bulletin {
    fn frame(
        &mut self,
        _: &FrameState,
        _: Moment,
        theatre: &Theatre,
        beat: &dyn Fn() -> BeatSummary,
    ) -> Result<(), FrontendError> {
        let stage = theatre.stage();
        if self.item.replace(stage.item) != Some(stage.item) {
            self.status.item = theatre.title().to_owned();
            self.note(&format!("it shows {}", theatre.title()));
        }
        let state = match stage.phase {
            Phase::Open => State::Open,
            Phase::Attract => State::Attract,
        };
        if self.status.state != state {
            self.state(state);
        }
        let faults = theatre.faults();
        if !faults.is_empty() && self.faults != faults {
            let laws = faults.join(", ");
            self.news.push(format!(
                "the world is against its laws ({laws}); please report this line with the tape"
            ));
        }
        self.faults = faults;
        let now = SystemTime::now();
        if self.file.as_ref().is_some_and(|file| file.is_due(now)) {
            let beat = beat();
            self.status.frames = beat.frames;
            self.status.late = beat.backends.iter().map(|backend| backend.late).sum();
            self.status.lost = beat.backends.iter().map(|backend| backend.lost).sum();
            self.write(now);
        }
        Ok(())
    }

    fn inputs(&mut self, inputs: Vec<InputStatus>) {
        self.status.inputs = inputs;
    }

    fn said(&mut self, _: Duration, sentence: &str) {
        self.note(sentence);
        if self.troubles.len() == MOST_TROUBLES {
            self.troubles.pop_front();
        }
        self.troubles.push_back(format!("{} {sentence}", time_text(SystemTime::now())));
    }

    fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }
}

/// What this process has of the system.
struct Usage {
    memory_mb: Option<f64>,
    open_files: Option<u64>,
}

/// As Linux tells it; nothing elsewhere.
fn usage() -> Usage {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:")?.split_whitespace().next());
    let memory_mb = resident.and_then(|kb| kb.parse::<f64>().ok()).map(|kb| kb / 1e3);
    let open_files = std::fs::read_dir("/proc/self/fd").ok().map(|files| files.count() as u64);
    Usage { memory_mb, open_files }
}

/// Space that is left where a file is, megabytes.
fn free_mb(path: &Path) -> Option<f64> {
    let space = rustix::fs::statvfs(path.parent()?).ok()?;
    Some(space.f_bavail as f64 * space.f_frsize as f64 / 1e6)
}
