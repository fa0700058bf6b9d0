//! Something that is wrong with an exhibit.

use serde::Serialize;
use std::fmt;

/// What is wrong, where, and what to do: one sentence.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Fault {
    /// The file, as messages call it.
    pub file: String,
    /// The line at which the entry begins that is wrong, from 1; None where it is the whole file.
    pub line: Option<usize>,
    /// The sentence.
    pub what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(out, "{}, line {line}: {}", self.file, self.what),
            None => write!(out, "{}: {}", self.file, self.what),
        }
    }
}
