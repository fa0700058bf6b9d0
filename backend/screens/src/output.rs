//! What a window system tells of its video outputs.

use serde::Serialize;

/// Pixels of the desktop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rectangle {
    /// Of its top left pixel.
    pub x: i16,
    /// Of its top left pixel.
    pub y: i16,
    /// Pixels along x.
    pub width: u16,
    /// Pixels along y.
    pub height: u16,
}

/// A way to drive an output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mode {
    /// Pixels along x.
    pub width: u16,
    /// Pixels along y.
    pub height: u16,
    /// Pictures per second; 0 where the server does not say.
    pub rate_hz: f64,
}

/// A video output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputInfo {
    /// The connector's name.
    pub connector: String,
    /// Whether anything is connected to it, as far as the server knows.
    pub is_connected: bool,
    /// What calls itself what there.
    pub product: Option<String>,
    /// The part of the desktop that it shows, and how; None where it is off.
    pub shows: Option<(Rectangle, Mode)>,
    /// The modes that it offers, the best first as the server sorts them.
    pub modes: Vec<Mode>,
}
