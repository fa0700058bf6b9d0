//! What can be wrong with a scene.

use super::names::PROCEDURAL_NAMES;
use std::path::PathBuf;

/// Why a scene cannot be read. Each is one sentence that says where, what, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The argument is not a scene.
    #[error("`{argument}` is not a scene; give a .toml scene, a .lloom store, or procedural:NAME with one of {}", PROCEDURAL_NAMES.join(", "))]
    NotAScene {
        /// What was given.
        argument: String,
    },
    /// The scene file cannot be read.
    #[error("cannot read the scene {}: {source}", path.display())]
    Read {
        /// The scene file.
        path: PathBuf,
        /// What the file system said.
        source: std::io::Error,
    },
    /// The store is not there.
    #[error("there is no volume {}; make it with `lightloom import IN -o {}`", path.display(), path.display())]
    NoStore {
        /// Where it was looked for.
        path: PathBuf,
    },
    /// An unknown procedural volume.
    #[error("there is no procedural volume `{name}`; use one of {}", PROCEDURAL_NAMES.join(", "))]
    UnknownProcedural {
        /// What was asked for.
        name: String,
    },
    /// A procedural volume of an impossible size.
    #[error("`{size}` is not a size in voxels; give a whole number from 1 to {largest} after the @")]
    ProceduralSize {
        /// What was asked for.
        size: String,
        /// The largest edge there can be.
        largest: u32,
    },
    /// Something in the scene file is wrong.
    #[error("{file}, line {line}: `{key}`: {message}")]
    InFile {
        /// The scene file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The key with its table, for instance `optics.extinction`.
        key: String,
        /// What is wrong, and what to do.
        message: String,
    },
    /// The scene's look depends on a volume that is not known yet.
    #[error(
        "{} has no [optics] in data values, so what it shows depends on the smallest and largest value of a volume, which an import knows only at its end; add [optics] to it, or leave bricks out with --empty-below",
        path.display()
    )]
    RelativeLook {
        /// The scene file.
        path: PathBuf,
    },
    /// The look does not fit the volume.
    #[error("the scene's look does not fit the volume, whose values run from {low} to {high}: {reason}")]
    Look {
        /// Smallest data value of the volume.
        low: f64,
        /// Largest data value of the volume.
        high: f64,
        /// What is wrong.
        reason: String,
    },
}

/// What a part of a scene file says, or what is wrong with it.
pub(super) type Checked<T> = Result<T, SceneError>;
