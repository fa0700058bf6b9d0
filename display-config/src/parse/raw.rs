//! The keys of a display file, before any check of their values.

use crate::text::ListOf;
use serde::Deserialize;
use toml::{Spanned, Value};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawDisplay {
    pub name: Spanned<String>,
    pub screen_width_m: Spanned<f64>,
    pub screen_height_m: Spanned<f64>,
    pub pixel_size_m: Spanned<f64>,
    pub angular_accuracy_deg: Spanned<f64>,
    pub observer_m: Spanned<ListOf<f64, 3>>,
    pub eta: Spanned<f64>,
    /// Absent for that of most projectors.
    pub rate_hz: Option<Spanned<f64>>,
    /// Absent where a line generates the projectors.
    pub projector: Option<Spanned<Vec<Spanned<RawProjector>>>>,
    pub projector_line: Option<Spanned<RawLine>>,
    /// The back-ends, in the order of their numbers.
    pub backend: Option<Vec<Spanned<RawBackend>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawBackend {
    pub adapter: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawProjector {
    pub name: Spanned<String>,
    pub centre_m: Spanned<ListOf<f64, 3>>,
    pub width_px: Spanned<u32>,
    pub height_px: Spanned<u32>,
    /// Left, bottom, width, height.
    pub screen_rect_m: Option<Spanned<ListOf<f64, 4>>>,
    /// Pixels to screen metres, by rows.
    pub homography: Option<Spanned<ListOf<ListOf<f64, 3>, 3>>>,
    /// The screen points of the raster's corners, clockwise from its top left.
    pub corners_m: Option<Spanned<ListOf<ListOf<f64, 2>, 4>>>,
    pub backend: Spanned<u32>,
    /// Absent where the projector is not to be driven.
    pub output: Option<Spanned<RawOutput>>,
    /// Absent where pictures are sent as they are, in sRGB.
    pub finish: Option<RawFinish>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawFinish {
    /// A file.
    pub mesh: Option<Spanned<String>>,
    /// A file.
    pub blend: Option<Spanned<String>>,
    /// A number, three of them, or a file.
    pub black_level: Option<Spanned<Value>>,
    /// A name, a gamma, or measured pairs.
    pub transfer: Option<Spanned<Value>>,
    pub dither: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawOutput {
    /// Absent for the whole desktop.
    pub name: Option<Spanned<String>>,
    pub x_px: Spanned<u32>,
    pub y_px: Spanned<u32>,
    #[serde(default)]
    pub mirrored: bool,
    /// Clockwise.
    pub turn_deg: Option<Spanned<i64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RawLine {
    pub count: Spanned<u32>,
    pub from_m: Spanned<ListOf<f64, 3>>,
    pub to_m: Spanned<ListOf<f64, 3>>,
    pub width_px: Spanned<u32>,
    pub height_px: Spanned<u32>,
    pub covers: Covers,
    pub backends: Spanned<u32>,
    /// The connectors of each back-end, for its projectors in turn.
    pub outputs: Option<Spanned<Vec<Spanned<String>>>>,
    /// The same for all of them.
    pub finish: Option<RawFinish>,
}

/// Where the rasters of a line of projectors fall.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Covers {
    Screen,
}
