//! Where the front-end meets what it drives: displays, volumes, importers and back-ends.
//!
//! Everything that the commands need from elsewhere passes through this folder and no other.

mod backends;
mod import;
mod levels;
mod store;

pub use backends::{BackendOptions, Backends};
pub use import::{ImportSummary, import};
pub use levels::LevelSummary;
pub use store::{StoreSummary, VerifySummary, store_summary, verify};

mod export;
mod replay;
mod trace;

pub use export::{ExportSummary, export};
pub use replay::{ReplayRow, Traces};
pub use trace::prepare_traces;

use crate::FrontendError;
use crate::scene::VolumeFacts;
use bricks::BrickSource;
use display_config::{Display, EyeModel};
use glam::{DVec2, DVec3};
use protocol::VolumeRef;
use std::sync::Arc;

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

/// What an eye sees of a display, before any picture is drawn.
pub struct EyeOptics {
    /// (projector, weight) pairs at a screen point, metres; they add to 1 where there are any.
    pub weights: Box<dyn Fn(DVec2) -> Vec<(usize, f64)>>,
    /// Where the eye is outside the viewing zone: a sentence that says so.
    pub warning: Option<String>,
}

/// The optics of an eye, metres in the display frame.
pub fn eye_optics(display: &Display, eye_m: DVec3) -> Result<EyeOptics, FrontendError> {
    let model = EyeModel::new(display, eye_m).map_err(|e| FrontendError::Display(e.to_string()))?;
    let warning = model.outside_zone();
    Ok(EyeOptics { weights: Box::new(move |screen| model.weights(screen)), warning })
}

/// A map from screen metres to a projector's pixel coordinates; None where the raster is singular.
pub fn pixel_from_screen(
    display: &Display,
    projector: usize,
) -> Option<impl Fn(DVec2) -> Option<DVec2> + use<>> {
    let inverse = display.projectors.get(projector)?.raster.inverse()?;
    Some(move |screen| inverse.pixel(screen))
}

/// Opens a volume just to learn what it is.
pub fn volume_facts(volume: &VolumeRef) -> Result<VolumeFacts, FrontendError> {
    Ok(VolumeFacts::of(open_volume(volume)?.as_ref()))
}

/// Opens a volume for work in this process.
pub fn open_volume(volume: &VolumeRef) -> Result<Arc<dyn BrickSource>, FrontendError> {
    backend::open_volume(volume).map_err(FrontendError::Volume)
}
