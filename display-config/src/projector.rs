//! One projector of a display.

use crate::Raster;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// One projector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projector {
    /// Its name, unique in the display.
    pub name: String,
    /// E: its centre of projection, z < 0 behind the screen or z > 0 in front of it, never in the screen plane.
    pub centre_in_display: DVec3,
    /// Its pixels.
    pub raster: Raster,
    /// Which back-end drives it, from 0.
    pub backend: u32,
}
