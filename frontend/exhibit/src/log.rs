//! What happened, line by line, in files that do not grow.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The same sentence again within this time is counted, and not written.
const REPEATS_WITHIN: Duration = Duration::from_secs(60);

/// How much of a log is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogLimits {
    /// A file that is larger gives way to the next, bytes.
    pub bytes: u64,
    /// Older files that are kept: `NAME.1` is the latest of them.
    pub keep: usize,
}

impl Default for LogLimits {
    fn default() -> Self {
        Self { bytes: 10_000_000, keep: 5 }
    }
}

/// A log.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    limits: LogLimits,
    file: File,
    bytes: u64,
    /// The last sentence, when it was written, and how often it has come again.
    last: Option<(String, SystemTime, u64)>,
    /// Whether the last line could not be written.
    is_stuck: bool,
}

/// A time of day as it stands in a log: UTC, to the millisecond.
pub fn time_text(at: SystemTime) -> String {
    humantime::format_rfc3339_millis(at).to_string()
}

impl Log {
    /// Goes on with the log of this name, or begins it.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn open(path: &Path, limits: LogLimits) -> io::Result<Self> {
        let file = OpenOptions::new().create(true).append(true).open(path)?;
        let bytes = file.metadata()?.len();
        Ok(Self { path: path.to_owned(), limits, file, bytes, last: None, is_stuck: false })
    }

    /// Writes a sentence down. Whether the log has just become unwritable: whoever writes it says so once, and the log
    /// goes on as soon as it can be written again.
    pub fn say(&mut self, at: SystemTime, sentence: &str) -> bool {
        let sentence = sentence.replace(|c: char| c.is_control(), " ");
        if let Some((last, since, times)) = &mut self.last {
            let is_soon = at.duration_since(*since).is_ok_and(|passed| passed < REPEATS_WITHIN);
            if *last == sentence && is_soon {
                *times += 1;
                return false;
            }
        }
        let was_stuck = self.is_stuck;
        let repeats = self.last.take().filter(|last| last.2 > 0);
        let written = repeats.map_or(Ok(()), |(last, since, times)| {
            self.write(at, &format!("{times} times more since {}: {last}", time_text(since)))
        });
        let written = written.and_then(|()| self.write(at, &sentence));
        self.last = Some((sentence, at, 0));
        self.is_stuck = written.is_err();
        self.is_stuck && !was_stuck
    }

    fn write(&mut self, at: SystemTime, sentence: &str) -> io::Result<()> {
        let line = format!("{} {sentence}\n", time_text(at));
        if self.bytes > 0 && self.bytes + line.len() as u64 > self.limits.bytes {
            self.rotate()?;
        }
        self.file.write_all(line.as_bytes())?;
        self.bytes += line.len() as u64;
        Ok(())
    }

    /// The file becomes the latest of the older ones.
    fn rotate(&mut self) -> io::Result<()> {
        let older = |number: usize| {
            let mut name = self.path.clone().into_os_string();
            name.push(format!(".{number}"));
            PathBuf::from(name)
        };
        for number in (1..self.limits.keep).rev() {
            if older(number).exists() {
                std::fs::rename(older(number), older(number + 1))?;
            }
        }
        match self.limits.keep {
            0 => std::fs::remove_file(&self.path)?,
            _ => std::fs::rename(&self.path, older(1))?,
        }
        self.file = OpenOptions::new().create(true).append(true).open(&self.path)?;
        self.bytes = 0;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: u64) -> SystemTime {
        SystemTime::UNIX_EPOCH + Duration::from_secs(seconds)
    }

    #[test]
    fn it_keeps_within_its_limits_and_nothing_is_lost_of_what_it_keeps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("day.log");
        let limits = LogLimits { bytes: 1000, keep: 3 };
        let mut log = Log::open(&path, limits).unwrap();
        for i in 0..200 {
            assert!(!log.say(at(i), &format!("sentence number {i}")));
        }
        let mut names: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["day.log", "day.log.1", "day.log.2", "day.log.3"]);
        let files = ["day.log.3", "day.log.2", "day.log.1", "day.log"];
        let text: String =
            files.iter().map(|name| std::fs::read_to_string(folder.path().join(name)).unwrap()).collect();
        let numbers: Vec<u64> =
            text.lines().map(|line| line.rsplit(' ').next().unwrap().parse().unwrap()).collect();
        assert!(numbers.len() > 60 && numbers.windows(2).all(|pair| pair[1] == pair[0] + 1), "{numbers:?}");
        assert_eq!(numbers.last(), Some(&199));
        assert!(std::fs::metadata(&path).unwrap().len() <= limits.bytes);
        drop(log);
        Log::open(&path, limits).unwrap().say(at(500), "sentence number 200");
        assert!(
            std::fs::read_to_string(&path)
                .unwrap()
                .ends_with("1970-01-01T00:08:20.000Z sentence number 200\n")
        );
    }

    #[test]
    fn what_repeats_is_counted_and_control_characters_are_blanks() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("day.log");
        let mut log = Log::open(&path, LogLimits::default()).unwrap();
        (0..50).for_each(|i| assert!(!log.say(at(i), "lost\nthe\x1b[2J wand")));
        log.say(at(55), "found it");
        log.say(at(120), "found it");
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().map(|line| line.split_once(' ').unwrap().1).collect();
        let again = "49 times more since 1970-01-01T00:00:00.000Z: lost the [2J wand";
        assert_eq!(lines, ["lost the [2J wand", again, "found it", "found it"]);
    }

    #[test]
    fn a_full_disk_is_told_once() {
        if !Path::new("/dev/full").exists() {
            return eprintln!("skipped: this system has no /dev/full");
        }
        let mut log = Log::open(Path::new("/dev/full"), LogLimits { bytes: 0, keep: 0 }).unwrap();
        let told: Vec<bool> = (0..3).map(|i| log.say(at(i), &format!("sentence {i}"))).collect();
        assert_eq!(told, [true, false, false]);
    }
}
