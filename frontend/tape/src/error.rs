//! Why a tape cannot be written or read.

use std::io;
use std::path::PathBuf;

/// Each is one sentence.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message beside each variant says what its fields are")]
pub enum TapeError {
    /// It cannot be written.
    #[error("cannot write the tape {}: {cause}; give a path in a folder that can be written and has space", path.display())]
    Write { path: PathBuf, cause: String },
    /// It cannot be read.
    #[error("cannot read the tape {}: {cause}; give the path of a tape", path.display())]
    Read { path: PathBuf, cause: io::Error },
    /// It is something else.
    #[error("{} is no tape of lightloom: {what}", path.display())]
    NoTape { path: PathBuf, what: String },
    /// It is of a later version.
    #[error("{} is a tape of format {found}, and this program reads up to {known}; use the program that wrote it, or a later one", path.display())]
    Newer { path: PathBuf, found: u32, known: u32 },
    /// A record cannot be understood.
    #[error("{} is damaged after {records} records: {what}; what stands before is whole", path.display())]
    Damaged { path: PathBuf, records: u64, what: String },
    /// Nothing lies in a range.
    #[error("nothing of the tape lies from {from_s} to {to_s} s; it is {length_s:.1} s long")]
    NothingThere { from_s: f64, to_s: f64, length_s: f64 },
    /// A table cannot be written.
    #[error("cannot write the table: {0}")]
    Export(io::Error),
}
