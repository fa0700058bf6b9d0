//! How an exhibit goes, in a file that is always whole.

use crate::log::time_text;
use serde::Serialize;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Between two writes, at least.
const INTERVAL: Duration = Duration::from_secs(1);

/// Where an exhibit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Back-ends and inputs are being started.
    Starting,
    /// Somebody does things, or did a while ago.
    Open,
    /// Nobody is there.
    Attract,
    /// It ended as it was meant to.
    Ended,
    /// It could not go on.
    Failed,
}

/// What a supervisor reads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// Where it is.
    pub state: State,
    /// When this was written, UTC: older than a few seconds means that it hangs.
    pub written: String,
    /// When it began.
    pub began: String,
    /// Its process.
    pub process: u32,
    /// The version of the program.
    pub version: String,
    /// What the exhibit is called.
    pub title: String,
    /// What is shown.
    pub item: String,
    /// Frames that were shown.
    pub frames: u64,
    /// Frames that were shown without a back-end that was late, of all back-ends.
    pub late: u64,
    /// How often a back-end was lost.
    pub lost: u64,
    /// Sources of inputs.
    pub inputs: Vec<InputStatus>,
    /// Memory of the process, megabytes; absent where the system does not tell.
    pub memory_mb: Option<f64>,
    /// Files that it has open.
    pub open_files: Option<u64>,
    /// Space that is left where tapes go, megabytes.
    pub disk_mb: Option<f64>,
    /// The latest troubles, sentence by sentence.
    pub troubles: Vec<String>,
}

impl Status {
    /// That of an exhibit of this process which starts now.
    pub fn starting(title: &str, version: &str, now: SystemTime) -> Self {
        let now = time_text(now);
        Self {
            state: State::Starting,
            written: now.clone(),
            began: now,
            process: std::process::id(),
            version: version.to_owned(),
            title: title.to_owned(),
            item: String::new(),
            frames: 0,
            late: 0,
            lost: 0,
            inputs: Vec::new(),
            memory_mb: None,
            open_files: None,
            disk_mb: None,
            troubles: Vec::new(),
        }
    }
}

/// What is known of a source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct InputStatus {
    /// Its name.
    pub name: String,
    /// Messages until now.
    pub messages: u64,
    /// Messages that were refused.
    pub refused: u64,
}

/// The file.
#[derive(Debug)]
pub struct StatusFile {
    path: PathBuf,
    written: Option<SystemTime>,
}

impl StatusFile {
    /// One of this name; nothing is written yet.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), written: None }
    }

    /// Whether it is time to write it again.
    pub fn is_due(&self, now: SystemTime) -> bool {
        let since = |written| now.duration_since(written).unwrap_or(INTERVAL);
        self.written.is_none_or(|written| since(written) >= INTERVAL)
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write(&mut self, now: SystemTime, status: &Status) -> io::Result<()> {
        self.written = Some(now);
        let mut part = self.path.clone().into_os_string();
        part.push(".part");
        let written = std::fs::write(&part, serde_json::to_vec_pretty(status)?);
        written.and_then(|()| std::fs::rename(&part, &self.path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn status(frames: u64) -> Status {
        Status { frames, ..Status::starting(&"x".repeat(20_000), "", SystemTime::UNIX_EPOCH) }
    }

    #[test]
    fn whoever_reads_it_while_it_is_written_reads_it_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("status.json");
        let mut file = StatusFile::new(&path);
        file.write(SystemTime::UNIX_EPOCH, &status(0)).unwrap();
        let is_over = AtomicBool::new(false);
        std::thread::scope(|scope| {
            let reader = scope.spawn(|| {
                let mut latest = 0;
                while !is_over.load(Ordering::Relaxed) {
                    let value: serde_json::Value =
                        serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
                    let frames = value["frames"].as_u64().unwrap();
                    assert!(frames >= latest);
                    latest = frames;
                }
                latest
            });
            (1..500).for_each(|i| file.write(SystemTime::UNIX_EPOCH, &status(i)).unwrap());
            is_over.store(true, Ordering::Relaxed);
            assert!(reader.join().unwrap() > 0);
        });
    }

    #[test]
    fn it_is_written_each_second() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = StatusFile::new(&folder.path().join("status.json"));
        let at = |ms| SystemTime::UNIX_EPOCH + Duration::from_millis(ms);
        assert!(file.is_due(at(5)));
        file.write(at(5), &status(0)).unwrap();
        assert!(!file.is_due(at(1004)) && file.is_due(at(1005)));
        assert!(StatusFile::new(Path::new("/no/such/folder/status")).write(at(0), &status(0)).is_err());
    }
}
