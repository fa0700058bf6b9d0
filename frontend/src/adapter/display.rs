//! Displays by their names.

use crate::FrontendError;
use display_config::{Display, Wiring};

/// The displays that come with the program: name, and a line about each.
pub fn preset_displays() -> Result<Vec<(String, String)>, FrontendError> {
    let about = |name: &str| {
        let display = load_display(name)?;
        let (count, (w, h)) = (display.projectors.len(), (display.width_m, display.height_m));
        Ok((name.to_owned(), format!("{count} projectors on a screen of {w:.2} × {h:.2} m")))
    };
    display_config::presets().iter().map(|(name, _)| about(name)).collect()
}

/// A preset by its name, or the display in a file.
pub fn load_display(name_or_path: &str) -> Result<Display, FrontendError> {
    Display::load(name_or_path).map_err(|e| FrontendError::Display(e.to_string()))
}

/// Whether every projector can be shown on an output by the back-end that drives it.
pub fn check_outputs(display: &Display, wiring: &Wiring) -> Result<(), FrontendError> {
    let checked = wiring.shares.iter().try_for_each(|share| display.check_outputs(share));
    checked.map_err(|e| FrontendError::Display(e.to_string()))
}
