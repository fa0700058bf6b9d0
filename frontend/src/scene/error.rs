//! What can be wrong with a scene.

use super::names::PROCEDURAL_NAMES;
use display_config::Place;
use display_config::text::{brief_number, brief_text, did_you_mean};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The longest path that a system takes, bytes.
const LONGEST_PATH: usize = 4096;

/// A path that a message can quote: whole, unless no file can have it.
fn named(path: &Path) -> Cow<'_, str> {
    let name = path.to_string_lossy();
    if name.len() > LONGEST_PATH { brief_text(&name).into_owned().into() } else { name }
}

/// Why a scene cannot be read. Each is one sentence that says where, what, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The argument is not a scene.
    #[error(
        "`{}` is not a scene; give a .toml scene, a .lloom store, or procedural:NAME with one of {}",
        brief_text(argument),
        PROCEDURAL_NAMES.join(", ")
    )]
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
    #[error(
        "{}there is no volume {}; make it with `lightloom import IN -o {}`",
        place.iter().map(|place| format!("{place}: ")).collect::<String>(),
        named(path),
        named(path)
    )]
    NoStore {
        /// What names it; None where that is the command line.
        place: Option<Place>,
        /// Where it was looked for.
        path: PathBuf,
    },
    /// An unknown procedural volume.
    #[error(
        "there is no procedural volume `{}`{}; use one of {}",
        brief_text(name),
        did_you_mean(name, PROCEDURAL_NAMES),
        PROCEDURAL_NAMES.join(", ")
    )]
    UnknownProcedural {
        /// What was asked for.
        name: String,
    },
    /// A procedural volume of an impossible size.
    #[error(
        "`{}` is not a size in voxels; give a whole number from 1 to {largest} after the @",
        brief_text(size)
    )]
    ProceduralSize {
        /// What was asked for.
        size: String,
        /// The largest edge there can be.
        largest: u32,
    },
    /// Something in the scene file is wrong.
    #[error("{place}: {message}")]
    InFile {
        /// The line and the key with its table, for instance `optics.extinction`.
        place: Place,
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
    /// What the scene's look shows cannot be told.
    #[error("what {} shows cannot be told: {reason}", path.display())]
    UnclearLook {
        /// The scene file.
        path: PathBuf,
        /// What is wrong with its look.
        reason: String,
    },
    /// A scene is to be written under a name that no scene has.
    #[error("`{}` would not be read as a scene; give it a name that ends in .toml", path.display())]
    SavedName {
        /// Where it was to go.
        path: PathBuf,
    },
    /// A scene is to be written over the file that it comes from.
    #[error("{} is the scene that is drawn; write what was used of it to another file", path.display())]
    SavedOverItself {
        /// The scene file.
        path: PathBuf,
    },
    /// A scene file cannot name its volume.
    #[error("a scene file cannot name {}, which is no text or begins like a built-in volume; rename it", path.display())]
    SavedVolume {
        /// The volume.
        path: PathBuf,
    },
    /// The look does not fit the volume.
    #[error(
        "the look of the scene `{}` does not fit the volume, whose values run from {} to {}: {reason}",
        brief_text(scene),
        brief_number(*low),
        brief_number(*high)
    )]
    Look {
        /// What people call the scene.
        scene: String,
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
