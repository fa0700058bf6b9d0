//! Where a scene's look comes from.

use super::LookName;

/// Which look a scene wishes for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WishedLook {
    /// That of its file's `[optics]`.
    Own,
    /// The one that is built in with a procedural volume.
    BuiltIn,
    /// Of the library: the one that fits the volume best.
    Best,
    /// Of the library: the one of this name.
    Named(LookName),
}

/// What a scene wishes for before it meets its volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LookWish {
    /// Which look.
    pub look: WishedLook,
    /// Whether a `[light]` of the scene's file takes the place of the look's.
    pub keeps_light: bool,
}
