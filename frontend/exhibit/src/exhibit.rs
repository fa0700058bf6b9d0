//! An exhibit that has been read and checked.

use std::path::PathBuf;
use std::time::Duration;
use world::{Cast, Handling, Rules};

/// All that an exhibit file says. Scenes and the display are names still: whoever opens them finds what is wrong with these.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// What it is called.
    pub title: String,
    /// Its file, as messages call it.
    pub file: String,
    /// A preset or a path.
    pub display: String,
    /// Frames per second, where not the display's.
    pub rate_hz: Option<f64>,
    /// The quality of all items, where not that of their scenes.
    pub quality: Option<String>,
    /// What is shown, at least one.
    pub items: Vec<ItemWish>,
    /// Visitors and their tools.
    pub cast: Cast,
    /// What they may do.
    pub rules: Rules,
    /// Sources of inputs, by their numbers.
    pub inputs: Vec<inputs::Input>,
    /// Where what happens is kept; None where it is not.
    pub tape: Option<TapeWish>,
    /// What is drawn over the volume.
    pub marks: MarkWish,
    /// The files that it was read from.
    pub files: Vec<PathBuf>,
}

/// What is drawn over the volume: everything, where the file says nothing, shining through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarkWish {
    /// Tools, where they are.
    pub tools: bool,
    /// Beside them, whose they are and what, and what their holders could not have.
    pub names: bool,
    /// Below the volume, what is shown.
    pub captions: bool,
    /// Whether tools lie among what they point at, instead of shining through it. What is written always shines through.
    pub depth_combined: bool,
}

impl MarkWish {
    /// Nothing is.
    pub const NONE: Self = Self { tools: false, names: false, captions: false, depth_combined: false };
}

/// An item of the programme.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemWish {
    /// The line at which it begins.
    pub line: usize,
    /// What visitors read of it; its scene's name where the file says nothing.
    pub title: Option<String>,
    /// A scene file, a store, or `procedural:NAME`.
    pub scene: String,
    /// Looks to go through.
    pub looks: Looks,
    /// How long it is shown; None until somebody asks for the next.
    pub time: Option<Duration>,
    /// Placements.
    pub presets: Vec<PresetWish>,
}

/// Looks that visitors go through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Looks {
    /// All that fit the volume.
    All,
    /// These.
    Named(Vec<String>),
}

/// A placement that somebody prepared.
#[derive(Clone, Debug, PartialEq)]
pub struct PresetWish {
    /// What visitors read of it.
    pub title: String,
    /// The placement.
    pub handling: Handling,
    /// The look by its name; None for the scene's own.
    pub look: Option<String>,
}

/// Where tapes go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TapeWish {
    /// The folder.
    pub folder: PathBuf,
    /// A tape that is larger gives way to the next, bytes.
    pub part_bytes: u64,
    /// The oldest of more tapes than this are removed.
    pub keep_parts: usize,
}
