//! Why an export failed.

use bricks::BrickError;
use bricks::volume::Element;
use std::path::{Path, PathBuf};

/// Why an export did not come about: one sentence that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A brick of the store is damaged.
    #[error(transparent)]
    Brick(#[from] BrickError),
    /// The name implies no format.
    #[error("the name {} implies no format: give one that ends in .nrrd or .zarr", path.display())]
    Name {
        /// The file or folder that was to be.
        path: PathBuf,
    },
    /// Something is there already.
    #[error("{} is there already and will not be replaced: give another name or remove it", path.display())]
    Exists {
        /// What is there.
        path: PathBuf,
    },
    /// A level or a part that the store does not have.
    #[error("the store has no such voxels: {what}")]
    Part {
        /// What it has.
        what: String,
    },
    /// A part that takes more memory than can be meant.
    #[error(
        "a plane of {width} × {height} voxels is too large for NRRD: choose a coarser level or a smaller part, or OME-Zarr"
    )]
    Plane {
        /// Voxels along x.
        width: u32,
        /// Voxels along y.
        height: u32,
    },
    /// The export was asked to stop.
    #[error("stopped: nothing was written to {}; the same command starts again from the beginning", path.display())]
    Interrupted {
        /// The file or folder that was to be.
        path: PathBuf,
    },
    /// A value beyond the numbers of a type.
    #[error("the value {value} does not fit into {element}: choose a larger type, or none")]
    Fit {
        /// The data value.
        value: f64,
        /// The type that was asked for.
        element: Element,
    },
    /// The file system said no.
    #[error("cannot write {}: {cause}; check the folder, its permissions and the free space", path.display())]
    Write {
        /// The file or folder that was to be.
        path: PathBuf,
        /// What it said.
        cause: std::io::Error,
    },
}

impl ExportError {
    pub(super) fn write(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |cause| ExportError::Write { path: path.into(), cause }
    }
}
