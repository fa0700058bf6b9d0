//! Tapes that are written while a show goes on: in a thread of its own, so that a slow disk holds up no frame.

use crate::error::TapeError;
use crate::head::Head;
use crate::names::{keep_latest, path_of};
use crate::part::Part;
use crate::record::{Record, Said, nanoseconds};
use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use std::path::{Path, PathBuf};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

/// Records that wait for the disk, at most: several seconds of three visitors.
const MOST_WAITING: usize = 8192;
/// How often a disk that is full is tried again.
const TRY_AGAIN: Duration = Duration::from_secs(10);

/// How large tapes become.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// A file that is larger gives way to the next part; None for one file.
    pub part_bytes: Option<u64>,
    /// Tapes that are kept, of parts and of earlier shows in the same folder whose names are the time; the oldest go. None keeps
    /// all.
    pub keep_parts: Option<usize>,
}

/// A tape that is being written.
pub struct Writer {
    records: Option<Sender<(Duration, Record)>>,
    news: Receiver<String>,
    thread: Option<JoinHandle<Result<(), TapeError>>>,
    /// Records that were left out since the tape last kept up.
    dropped: u64,
}

impl Writer {
    /// Begins a tape of this name; further parts have a number in theirs.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(path: &Path, head: Head, limits: Limits) -> Result<Self, TapeError> {
        let head = Head { part: 1, ..head };
        let part = Part::create(path, &head).map_err(|cause| cannot_write(path, &cause))?;
        limits.keep_parts.iter().for_each(|&keep| keep_latest(path, keep));
        let (records, inbox) = bounded(MOST_WAITING);
        let (tell, news) = unbounded();
        let tape =
            Tape { base: path.to_owned(), head, limits, part: Some(part), failed_at: None, lost: 0, tell };
        let thread = Builder::new().name("taping".to_owned()).spawn(move || tape.run(&inbox));
        let thread =
            thread.map_err(|cause| TapeError::Write { path: path.to_owned(), cause: cause.to_string() })?;
        Ok(Self { records: Some(records), news, thread: Some(thread), dropped: 0 })
    }

    /// Adds a record that reached the world at a time of the display's clock. It never waits: where the disk is too slow,
    /// records are left out, and the tape says so.
    pub fn write(&mut self, now: Duration, record: Record) {
        let Some(records) = &self.records else { return };
        if self.dropped > 0 {
            let text = format!("the disk was too slow: {} records are missing before this one", self.dropped);
            let gap = Record::Said(Said { now_ns: nanoseconds(now), text });
            if records.try_send((now, gap)).is_err() {
                self.dropped += 1;
                return;
            }
            self.dropped = 0;
        }
        if let Err(TrySendError::Full(_)) = records.try_send((now, record)) {
            self.dropped += 1;
        }
    }

    /// What has become of it since this was last asked, in sentences.
    pub fn news(&self) -> Vec<String> {
        self.news.try_iter().collect()
    }

    /// Completes it.
    ///
    /// # Errors
    /// The end of it cannot be written.
    pub fn finish(mut self) -> Result<(), TapeError> {
        self.records = None;
        self.thread.take().map_or(Ok(()), |thread| thread.join().unwrap_or(Ok(())))
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.records = None;
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn cannot_write(path: &Path, cause: &mcap::McapError) -> TapeError {
    TapeError::Write { path: path.to_owned(), cause: cause.to_string() }
}

/// The thread's side.
struct Tape {
    base: PathBuf,
    head: Head,
    limits: Limits,
    /// None while it cannot be written.
    part: Option<Part>,
    failed_at: Option<Duration>,
    lost: u64,
    tell: Sender<String>,
}

impl Tape {
    fn run(mut self, inbox: &Receiver<(Duration, Record)>) -> Result<(), TapeError> {
        for (now, record) in inbox {
            self.take(now, &record);
        }
        let path = path_of(&self.base, self.head.part);
        self.part.take().map_or(Ok(()), Part::finish).map_err(|cause| cannot_write(&path, &cause))
    }

    fn take(&mut self, now: Duration, record: &Record) {
        if self.part.is_none() && self.failed_at.is_some_and(|at| now >= at + TRY_AGAIN) {
            self.begin_part(now);
        }
        let Some(part) = &mut self.part else {
            self.lost += 1;
            return;
        };
        if let Err(cause) = part.write(now, record) {
            self.fail(now, &cause.to_string());
            return;
        }
        let path = path_of(&self.base, self.head.part);
        let is_full = |most| std::fs::metadata(&path).is_ok_and(|found| found.len() > most);
        // A part ends at a frame, so that each begins with what leads to the next one.
        if matches!(record, Record::Frame(_)) && self.limits.part_bytes.is_some_and(is_full) {
            if let Some(Err(cause)) = self.part.take().map(Part::finish) {
                self.fail(now, &cause.to_string());
                return;
            }
            self.begin_part(now);
        }
    }

    fn begin_part(&mut self, now: Duration) {
        self.head.part += 1;
        // One fewer, for the part that begins: it may be the disk that is full.
        self.limits.keep_parts.iter().for_each(|keep| keep_latest(&self.base, keep.saturating_sub(1)));
        match Part::create(&path_of(&self.base, self.head.part), &self.head) {
            Ok(mut part) => {
                if self.failed_at.take().is_some() {
                    let text =
                        format!("{} records are missing before this part", std::mem::take(&mut self.lost));
                    let _ = self.tell.send(format!("the tape is written again; {text}"));
                    let _ = part.write(now, &Record::Said(Said { now_ns: nanoseconds(now), text }));
                }
                self.part = Some(part);
            }
            Err(cause) => self.fail(now, &cause.to_string()),
        }
    }

    fn fail(&mut self, now: Duration, cause: &str) {
        if self.failed_at.replace(now).is_none() {
            let path = path_of(&self.base, self.head.part);
            let error = TapeError::Write { path, cause: cause.to_owned() };
            let _ = self.tell.send(format!("{error}; the show goes on without it"));
        }
        self.part = None;
        self.lost += 1;
    }
}
