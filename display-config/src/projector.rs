//! One projector of a display.

use crate::{CanonicalRaster, Finish, Raster, Warp};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// One projector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projector {
    /// Its name, unique in the display.
    pub name: String,
    /// E: its centre of projection, z < 0 behind the screen or z > 0 in front of it, never in the screen plane.
    pub centre_in_display: DVec3,
    /// Its pixels, as they are drawn; where a mesh says where they fall, the picture that it takes its light from.
    pub raster: Raster,
    /// Which back-end drives it, from 0.
    pub backend: u32,
    /// From its picture to its codes.
    pub finish: Finish,
}

impl Projector {
    /// Whether this and another have pixels of an output of one host in common.
    pub fn shares_pixels(&self, other: &Self) -> bool {
        match (&self.raster.output, &other.raster.output) {
            (Some(one), Some(two)) => one.overlaps(self.raster.pixels(), two, other.raster.pixels()),
            _ => false,
        }
    }

    /// The way from the raster that a display's projectors share to its own; None where they coincide.
    pub fn warp(&self, canonical: &CanonicalRaster) -> Option<Warp> {
        Warp::between(canonical, &self.raster)
    }
}
