//! What can be wrong with a file of inputs.

use std::fmt;
use std::path::PathBuf;

/// A key of an entry of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as messages call it.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The entry's name or, without one, its number from 1.
    pub entry: String,
    /// The key.
    pub key: String,
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}, line {}, input {}: `{}`", self.file, self.line, self.entry, self.key)
    }
}

/// Why inputs cannot be read or started. Each is one sentence that says where, what, and what to do.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message beside each variant says what its fields are")]
pub enum InputError {
    /// The file cannot be read.
    #[error("cannot read the input file {}: {cause}; give the path of a readable .toml file", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    /// Not TOML.
    #[error("{file}, line {line}: this is not TOML ({message}); correct the line")]
    Syntax { file: String, line: usize, message: String },
    /// TOML, and no list of inputs.
    #[error("{file} is no input file ({message}); give it [[input]] entries and nothing else")]
    NoInputs { file: String, message: String },
    /// A key that nothing reads.
    #[error("{place} is not a key of {of}{suggestion}; remove it, or use one of {known}")]
    UnknownKey { place: Box<Place>, of: String, suggestion: String, known: String },
    /// A key that is needed.
    #[error("{place} is missing from the entry that starts here; add it")]
    MissingKey { place: Box<Place> },
    /// A value that means nothing.
    #[error("{place} is {value}{suggestion}; give {expected}")]
    WrongValue { place: Box<Place>, value: String, suggestion: String, expected: String },
    /// Two keys, or none, where one says all.
    #[error("{place} and `{other}` exclude each other; keep one of the two")]
    TwoKeys { place: Box<Place>, other: &'static str },
    /// Two inputs of one name.
    #[error("{place} is already the name of another input; give each its own")]
    DuplicateName { place: Box<Place> },
    /// A script that cannot be run.
    #[error("{place} names {}, which cannot be run: {message}", path.display())]
    Script { place: Box<Place>, path: PathBuf, message: String },
    /// A transform that cannot be read.
    #[error("{place} names {}, which is no calibration: {message}; write one with `lightloom calibrate tracker`", path.display())]
    Calibration { place: Box<Place>, path: PathBuf, message: String },
    /// No thread.
    #[error("cannot start the thread of input {input}: {cause}; end other programs")]
    Thread { input: String, cause: std::io::Error },
}
