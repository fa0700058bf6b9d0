//! `lightloom displays`.

use super::say;
use crate::{FrontendError, session};

/// Lists the presets.
pub(super) fn displays() -> Result<(), FrontendError> {
    for (name, about) in session::preset_displays()? {
        say(&format!("{name:<12} {about}"));
    }
    Ok(())
}
