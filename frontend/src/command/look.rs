//! How commands that draw ask for a look, and tell which one was taken.

use super::say::{say, warn};
use crate::FrontendError;
use crate::scene::{LookChoice, LookName, Scene};

/// Asks for the look of the command line, over which a scene's own one wins.
pub(super) fn ask_for_look(scene: &mut Scene, name: Option<LookName>) {
    if let Some(name) = name
        && !scene.wish_for(name)
    {
        warn(&format!("the scene has [optics] of its own, which win over --look {name}"));
    }
}

/// Tells which look was taken, and why.
pub(super) fn tell_look(look: Option<&LookChoice>) -> Result<(), FrontendError> {
    look.map_or(Ok(()), |look| say(&look.to_string()))
}
