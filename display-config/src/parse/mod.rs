//! From the text of a display file to a display whose every number has been checked.

mod entry;
mod finish;
mod line;
mod output;
mod raw;
mod source;

use crate::text::{brief_text, did_you_mean, read_text};
use crate::{ConfigError, Display, Projector, RATES_HZ, presets};
use glam::{DVec2, DVec3};
use raw::{RawBackend, RawDisplay};
use source::Source;
use std::path::Path;
use toml::Spanned;

impl Display {
    /// The display that a file's text describes. `file` is what messages call it; files that it names are looked for in the
    /// working folder.
    ///
    /// # Errors
    /// Text that is not TOML, unknown or missing keys, values of the wrong type or without meaning: each names the
    /// file, the line and the key. Nothing that changes the geometry has a default.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, ConfigError> {
        Self::from_toml_in(Path::new(""), text, file)
    }

    fn from_toml_in(folder: &Path, text: &str, file: &str) -> Result<Self, ConfigError> {
        let source = Source { text, file, folder };
        checked(&source, &source.read()?)
    }

    /// A preset by its name, or the display in a `.toml` file by its path.
    ///
    /// # Errors
    /// A name that is neither, a file that cannot be read, and those of [`Display::from_toml`].
    pub fn load(name_or_path: &str) -> Result<Self, ConfigError> {
        if let Some((name, text)) = presets().iter().find(|(name, _)| *name == name_or_path) {
            return Self::from_toml(text, &format!("preset {name}"));
        }
        let path = Path::new(name_or_path);
        if path.extension().is_none_or(|extension| extension != "toml") {
            let names: Vec<&str> = presets().iter().map(|(name, _)| *name).collect();
            return Err(ConfigError::UnknownPreset {
                name: brief_text(name_or_path).into_owned(),
                suggestion: did_you_mean(name_or_path, names.iter().copied()),
                presets: names.join(", "),
            });
        }
        let text = read_text(path).map_err(|cause| ConfigError::Read { path: path.to_owned(), cause })?;
        Self::from_toml_in(path.parent().unwrap_or(Path::new("")), &text, name_or_path)
    }
}

/// Positive lengths, as messages ask for them.
const A_LENGTH: &str = "a length in metres, above 0 and at most 1000000";

/// Rates, as messages ask for them.
const A_RATE: &str = "a rate in pictures per second, from 0.1 to 1000";

/// What most projectors show, pictures per second.
const USUAL_RATE_HZ: f64 = 60.0;

fn is_rate(hz: f64) -> bool {
    (RATES_HZ.0..=RATES_HZ.1).contains(&hz)
}

fn checked(source: &Source<'_>, raw: &RawDisplay) -> Result<Display, ConfigError> {
    let width_m = source.positive("screen_width_m", &raw.screen_width_m, A_LENGTH)?;
    let height_m = source.positive("screen_height_m", &raw.screen_height_m, A_LENGTH)?;
    let accuracy = "an angle in degrees above 0 and below 180";
    let accuracy_deg = source
        .within("angular_accuracy_deg", &raw.angular_accuracy_deg, accuracy, |a| a > 0.0 && a < 180.0)?;
    let eta = "a number from 0 (one perspective view) to 1 (full horizontal parallax)";
    let projectors = projectors(source, raw, DVec2::new(width_m, height_m))?;
    let adapters = adapters(source, raw, &projectors)?;
    Ok(Display {
        name: source.name("name", &raw.name)?,
        width_m,
        height_m,
        pixel_size_m: source.positive("pixel_size_m", &raw.pixel_size_m, A_LENGTH)?,
        angular_accuracy: accuracy_deg.to_radians(),
        observer_in_display: observer(source, raw)?,
        eta: source.within("eta", &raw.eta, eta, |eta| (0.0..=1.0).contains(&eta))?,
        rate_hz: raw
            .rate_hz
            .as_ref()
            .map_or(Ok(USUAL_RATE_HZ), |rate| source.within("rate_hz", rate, A_RATE, is_rate))?,
        projectors,
        adapters,
    })
}

fn observer(source: &Source<'_>, raw: &RawDisplay) -> Result<DVec3, ConfigError> {
    let (key, span) = ("observer_m", raw.observer_m.span());
    let observer = source.point(key, &raw.observer_m)?;
    if observer.z <= 0.0 {
        let expected = "an observer before the screen, with z (the third number) above 0";
        return Err(source.out_of_range(key, span, observer.z, expected));
    }
    Ok(observer)
}

fn projectors(source: &Source<'_>, raw: &RawDisplay, screen: DVec2) -> Result<Vec<Projector>, ConfigError> {
    match (&raw.projector, &raw.projector_line) {
        (None, Some(line)) => line::projectors(source, line.get_ref(), screen),
        (Some(list), None) if !list.get_ref().is_empty() => entry::projectors(source, list.get_ref(), screen),
        (Some(_), Some(line)) => {
            Err(ConfigError::TwoLists { place: source.place("projector_line", line.span()) })
        }
        (list, None) => {
            let span = list.as_ref().map_or(0..0, Spanned::span);
            Err(ConfigError::NoProjectors { place: source.place("projector", span) })
        }
    }
}

/// The adapters that back-ends ask for. There are no tables for back-ends without projectors.
fn adapters(
    source: &Source<'_>,
    raw: &RawDisplay,
    projectors: &[Projector],
) -> Result<Vec<Option<String>>, ConfigError> {
    let tables = raw.backend.as_deref().unwrap_or_default();
    let wired = projectors.iter().map(|projector| projector.backend as usize + 1).max().unwrap_or(0);
    if let Some(table) = tables.get(wired) {
        let place = source.place("backend", table.span());
        return Err(ConfigError::BackendWithoutProjectors { place, number: wired, highest: wired - 1 });
    }
    let asked = |table: &Spanned<RawBackend>| {
        table.get_ref().adapter.as_ref().map(|adapter| source.name("adapter", adapter)).transpose()
    };
    tables.iter().map(asked).collect()
}

#[cfg(test)]
mod tests;
