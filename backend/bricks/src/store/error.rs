//! Why a store could not be built or opened.

use super::format::VERSION;
use crate::volume::VolumeError;
use std::path::{Path, PathBuf};

/// Why a store could not be built or opened: one sentence that names the file and says what to do.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The source volume could not be read.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// Nothing can be written there.
    #[error("cannot write {}: {cause}; check the folder, its permissions and the free space", path.display())]
    Write {
        /// The store that was to be, or the working file beside it.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The store is missing, or may not be read.
    #[error("cannot open {}: {cause}; check the path and the permissions", path.display())]
    Open {
        /// The store.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The file does not start as a store does.
    #[error("{} is not a lightloom store: import the volume first", path.display())]
    NotAStore {
        /// The file.
        path: PathBuf,
    },
    /// Something else has the store's name.
    #[error("{} exists already and is not a lightloom store: choose another name, or remove it first", path.display())]
    Occupied {
        /// What is there.
        path: PathBuf,
    },
    /// The build was asked to stop.
    #[error("stopped: nothing was written to {}; the same command starts again from the beginning", path.display())]
    Interrupted {
        /// The store that was to be.
        path: PathBuf,
    },
    /// A store of another version of the format.
    #[error("{} has store format version {found}, but this program reads versions 1 to {VERSION}: import the volume again", path.display())]
    Version {
        /// The store.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// A store that contradicts itself.
    #[error("{} is damaged: {what}; copy it again or import the volume again", path.display())]
    Damaged {
        /// The store.
        path: PathBuf,
        /// What does not fit.
        what: String,
    },
    /// A request that makes no sense.
    #[error("cannot import {input}: {what}")]
    Input {
        /// The input as it was given.
        input: String,
        /// What would be right.
        what: String,
    },
}

impl StoreError {
    pub(super) fn write(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |cause| StoreError::Write { path: path.into(), cause }
    }

    pub(super) fn open(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |cause| StoreError::Open { path: path.into(), cause }
    }

    pub(super) fn damaged(path: &Path, what: impl Into<String>) -> Self {
        StoreError::Damaged { path: path.into(), what: what.into() }
    }
}
