//! What can go wrong when a picture becomes a file.

use std::path::{Path, PathBuf};

/// Why an output could not be made.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file system said no.
    #[error("cannot write {}: {source}; check permissions and free space, or give another folder", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What it said.
        source: std::io::Error,
    },
    /// An encoder said no.
    #[error("cannot encode {}: {reason}; check the free space, or give another folder", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What it said.
        reason: String,
    },
    /// The numbers of a picture are not as many as its size says.
    #[error("a picture of {width} x {height} pixels has {numbers} numbers; it needs 4 per pixel")]
    Size {
        /// Pixels along x.
        width: u32,
        /// Pixels along y.
        height: u32,
        /// How many numbers there are.
        numbers: usize,
    },
    /// Two pictures that were to be compared differ in size.
    #[error("pictures of {0} x {1} and {2} x {3} pixels cannot be compared; give two of one size")]
    SizesDiffer(u32, u32, u32, u32),
}

impl OutputError {
    /// A failed write of `path`.
    pub(super) fn write(path: &Path, source: std::io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }

    /// A failed encoding of `path`.
    pub(super) fn encode(path: &Path, reason: impl ToString) -> Self {
        Self::Encode { path: path.to_owned(), reason: reason.to_string() }
    }
}
