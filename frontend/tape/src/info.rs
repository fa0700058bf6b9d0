//! What is on a tape.

use crate::error::TapeError;
use crate::head::Head;
use crate::reader::Tape;
use crate::record::Record;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use world::Deed;

/// How a tape ends.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// It was completed.
    Whole,
    /// It was not, or is damaged: why, in a sentence.
    Cut(String),
}

/// What is on a tape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Info {
    /// Its head.
    pub head: Head,
    /// Files that go with it, and their bytes.
    pub files: BTreeMap<String, usize>,
    /// From the first to the last frame, seconds.
    pub length_s: f64,
    /// Frames.
    pub frames: u64,
    /// Events of each source by its name.
    pub events: BTreeMap<String, u64>,
    /// What mouse and keys did.
    pub changes: u64,
    /// Sentences.
    pub said: u64,
    /// How it ends.
    pub ending: Ending,
}

/// Reads a tape for what is on it.
///
/// # Errors
/// It is no tape.
pub fn info(path: &Path) -> Result<Info, TapeError> {
    let tape = Tape::open(path)?;
    let head = tape.head().clone();
    let files = head.files.iter().map(|file| (file.name.clone(), file.bytes.len())).collect();
    let events = head.sources.iter().map(|name| (name.clone(), 0)).collect();
    let mut info =
        Info { head, files, length_s: 0.0, frames: 0, events, changes: 0, said: 0, ending: Ending::Whole };
    let mut first_ns = None;
    for record in tape.records() {
        match record {
            Ok(Record::Deed(Deed::Event(event))) => {
                let name = info.head.sources.get(usize::from(event.source.0));
                let name = name.cloned().unwrap_or_else(|| event.source.0.to_string());
                *info.events.entry(name).or_default() += 1;
            }
            Ok(Record::Deed(Deed::Change(_))) => info.changes += 1,
            Ok(Record::Frame(frame)) => {
                info.frames += 1;
                let first_ns = *first_ns.get_or_insert(frame.now_ns);
                info.length_s = 1e-9 * frame.now_ns.saturating_sub(first_ns) as f64;
            }
            Ok(Record::Said(_)) => info.said += 1,
            Err(error) => info.ending = Ending::Cut(error.to_string()),
        }
    }
    Ok(info)
}
