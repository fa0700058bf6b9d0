//! A display: screen, observer, projectors.

use crate::Homography;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A light-field display. Display frame: metres, origin at the screen's centre, x right, y up, z toward the viewers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Display {
    /// Its name.
    pub name: String,
    /// Width of the screen, metres.
    pub width_m: f64,
    /// Height of the screen, metres.
    pub height_m: f64,
    /// s0: pixel size on the screen, metres.
    pub pixel_size_m: f64,
    /// Φ: angular accuracy, radians.
    pub angular_accuracy: f64,
    /// V: the virtual observer, z > 0.
    pub observer_in_display: DVec3,
    /// η: 0 one perspective view, 1 full horizontal parallax.
    pub eta: f64,
    /// Its projectors, in the order of their pictures.
    pub projectors: Vec<Projector>,
}

/// One projector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projector {
    /// Its name, unique in the display.
    pub name: String,
    /// E: its centre of projection, z < 0 behind the screen or z > 0 before it, never in the screen plane.
    pub centre_in_display: DVec3,
    /// Its pixels.
    pub raster: Raster,
    /// Which back-end drives it, from 0.
    pub backend: u32,
}

/// A projector's pixels, and where they fall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Raster {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Pixel coordinates (x right, y down, pixel centres at integer + 0.5) to screen metres (x right, y up).
    pub screen_from_pixel: Homography,
    /// The part of a video output this raster is, as (output name, x, y of its first pixel there); None = an output of its own.
    pub output: Option<(String, u32, u32)>,
}
