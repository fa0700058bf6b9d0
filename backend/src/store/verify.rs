//! Checking every byte of a store.

use super::StoreError;
use std::path::Path;

/// What a check found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verification {
    /// Bricks that were read.
    pub bricks: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// What is wrong: one sentence each that names the place; empty for a whole store. At most the first
    /// [`MOST_DAMAGES`].
    pub damages: Vec<String>,
    /// How many there are, listed or not.
    pub damage_count: u64,
}

/// Longest list of damages.
pub const MOST_DAMAGES: usize = 100;

/// Reads and checks all of a store: header, table, every brick and what lies between. `progress` is told
/// (done, total) in bytes.
///
/// # Errors
/// A file that cannot be opened as a store at all.
pub fn verify(path: &Path, progress: &dyn Fn(u64, u64)) -> Result<Verification, StoreError> {
    let _ = (path, progress);
    todo!()
}
