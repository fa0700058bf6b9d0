//! `lightloom displays`.

use super::say::say;
use crate::{FrontendError, adapter};

/// Lists the presets.
pub(super) fn displays() -> Result<(), FrontendError> {
    for (name, about) in adapter::preset_displays()? {
        say(&format!("{name:<12} {about}"))?;
    }
    Ok(())
}
