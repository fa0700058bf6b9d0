//! Where points land in a projector's picture.

use display_config::{BeamLaw, Homography, Raster, RasterInverse, Ray};
use glam::{DVec2, DVec3, UVec2};

/// Lengths that the projection magnifies more than this are so near to a plane of no image that nothing of them is drawn.
const MOST_MAGNIFIED: f64 = 20.0;

/// The pieces of an edge may be off by this, pixels.
pub(crate) const FLAT_PX: f64 = 0.05;
/// An edge is halved this often at most: 4096 pieces.
pub(crate) const MOST_HALVINGS: u32 = 12;

/// Where points of the display frame land in the picture of a projector.
#[derive(Clone, Debug)]
pub struct View {
    law: BeamLaw,
    screen_from_pixel: Homography,
    inverse: RasterInverse,
    size: UVec2,
}

impl View {
    /// Of a projector's rays and pixels. None for a singular calibration.
    pub fn new(law: BeamLaw, raster: &Raster) -> Option<Self> {
        let Raster { screen_from_pixel, .. } = *raster;
        Some(Self { law, screen_from_pixel, inverse: raster.inverse()?, size: raster.pixels() })
    }

    /// Pixels along x and y.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The pixel coordinates of a point, in display frame metres: y down, centres at integer + 0.5, also outside the picture.
    /// None where it has no image.
    pub fn pixel(&self, point: DVec3) -> Option<DVec2> {
        self.inverse.pixel(self.law.screen_from_point(point).ok()?)
    }

    /// The ray of the middle of a pixel.
    pub(crate) fn ray(&self, pixel: UVec2) -> Ray {
        self.law.ray(self.screen_from_pixel.apply(pixel.as_dvec2() + 0.5))
    }

    /// How far a point is from where nothing is drawn; below 0 beyond. Two numbers that are linear in the point.
    pub(crate) fn margins(&self, point: DVec3) -> DVec2 {
        self.law.divisors(point.z) - 1.0 / MOST_MAGNIFIED
    }
}
