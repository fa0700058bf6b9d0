//! A projector's own raster: its pixels on the screen, as calibrated.

use crate::{Homography, Output};
use glam::{DVec2, UVec2};
use serde::{Deserialize, Serialize};

/// A point this far outside the raster still counts as covered, pixels: the screen's own edge must not be lost to rounding.
pub const COVER_TOLERANCE_PX: f64 = 1e-6;

/// Corners whose turn is below this share of the raster's squared extent lie on a line.
const FLAT: f64 = 1e-9;

/// A projector's pixels, and where they fall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Raster {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Pixel coordinates (x right, y down, pixel centres at integer + 0.5) to screen metres (x right, y up).
    pub screen_from_pixel: Homography,
    /// Where it is shown; None where the display file does not say.
    pub output: Option<Output>,
}

impl Raster {
    /// Its size in pixels.
    pub fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// Its pixels along x and y.
    pub fn pixels(&self) -> UVec2 {
        UVec2::new(self.width, self.height)
    }

    /// The screen point of the centre of pixel (x, y), metres.
    pub fn pixel_on_screen(&self, x: u32, y: u32) -> DVec2 {
        self.screen_from_pixel.apply(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
    }

    /// The pixel coordinates of a screen point, also outside the raster. None if the point has no pixel (beyond
    /// the horizon of the calibration, or a singular calibration). For many points, keep [`Raster::inverse`].
    pub fn pixel_from_screen(&self, screen: DVec2) -> Option<DVec2> {
        self.inverse()?.pixel(screen)
    }

    /// Whether the raster covers a screen point, edges included.
    pub fn covers(&self, screen: DVec2) -> bool {
        self.inverse().is_some_and(|inverse| inverse.covers(screen))
    }

    /// The way back from the screen, computed once. None for a singular calibration.
    pub fn inverse(&self) -> Option<RasterInverse> {
        let centre = self.screen_from_pixel.depth(self.size() / 2.0);
        let inverse = self.screen_from_pixel.inverse()?;
        Some(RasterInverse {
            pixel_from_screen: Homography(inverse.0 * centre.signum()),
            last: self.size() + COVER_TOLERANCE_PX,
        })
    }

    /// The screen points of its corners, clockwise in the raster from its top left.
    pub fn corners_on_screen(&self) -> [DVec2; 4] {
        self.corners().map(|corner| self.screen_from_pixel.apply(corner))
    }

    /// Whether the raster falls on the screen as a proper quadrilateral: finite, of some area, with no corner beyond
    /// the calibration's horizon.
    pub fn is_regular(&self) -> bool {
        let depths = self.corners().map(|corner| self.screen_from_pixel.depth(corner));
        let one_side = depths.iter().all(|&d| d > 0.0) || depths.iter().all(|&d| d < 0.0);
        one_side && is_strictly_convex(self.corners_on_screen()) && self.inverse().is_some()
    }

    fn corners(&self) -> [DVec2; 4] {
        let size = self.size();
        [DVec2::ZERO, DVec2::new(size.x, 0.0), size, DVec2::new(0.0, size.y)]
    }
}

/// Whether four points turn the same way at each corner, clearly. Not for NaN or infinity.
pub(crate) fn is_strictly_convex(corners: [DVec2; 4]) -> bool {
    let extent = (corners[2] - corners[0]).length_squared().max((corners[3] - corners[1]).length_squared());
    let turns: [f64; 4] = std::array::from_fn(|i| {
        let (here, next, after) = (corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]);
        (next - here).perp_dot(after - next) / extent
    });
    turns.iter().all(|&turn| turn > FLAT) || turns.iter().all(|&turn| turn < -FLAT)
}

/// The map from the screen to a raster's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterInverse {
    /// Scaled so that the third component is positive on the raster's side of the horizon.
    pixel_from_screen: Homography,
    /// The largest covered pixel coordinates, tolerance included.
    last: DVec2,
}

impl RasterInverse {
    /// The pixel coordinates of a screen point; None if it has none.
    pub fn pixel(&self, screen: DVec2) -> Option<DVec2> {
        let image = self.pixel_from_screen.0 * screen.extend(1.0);
        let pixel = image.truncate() / image.z;
        (image.z > 0.0 && pixel.is_finite()).then_some(pixel)
    }

    /// Whether the raster covers a screen point, edges included.
    pub fn covers(&self, screen: DVec2) -> bool {
        self.pixel(screen).is_some_and(|pixel| {
            pixel.min_element() >= -COVER_TOLERANCE_PX && pixel.x <= self.last.x && pixel.y <= self.last.y
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};

    const SIZE: DVec2 = DVec2::new(800.0, 600.0);

    fn raster(screen_from_pixel: Homography) -> Raster {
        Raster { width: 800, height: 600, screen_from_pixel, output: None }
    }

    fn whole_screen() -> Raster {
        raster(Homography::of_rectangle(SIZE, DVec2::new(-0.8, -0.45), DVec2::new(1.6, 0.9)))
    }

    #[test]
    fn pixel_centres_come_back() {
        let raster = whole_screen();
        for (x, y) in [(0, 0), (799, 599), (400, 17)] {
            let pixel = raster.pixel_from_screen(raster.pixel_on_screen(x, y)).unwrap();
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert!((pixel - centre).length() < 1e-9, "{pixel} is not {centre}");
        }
    }

    #[test]
    fn the_screens_own_corners_are_covered_and_no_more() {
        let raster = whole_screen();
        for corner in raster.corners_on_screen() {
            assert!(raster.covers(corner));
            assert!(!raster.covers(corner * 1.001));
        }
        assert!(!raster.covers(DVec2::NAN));
    }

    #[test]
    fn nothing_beyond_the_horizon_is_covered() {
        // w falls from 1 to 0.2 across the raster: screen points beyond the vanishing line have no pixel on this side.
        let tilted =
            DMat3::from_cols(DVec3::new(0.001, 0.0, -0.001), DVec3::Y * 0.001, DVec3::new(0.0, 0.0, 1.0));
        for sign in [1.0, -1.0] {
            let raster = raster(Homography(tilted * sign));
            assert!(raster.is_regular());
            assert!(raster.covers(raster.pixel_on_screen(400, 300)));
            let beyond = raster.screen_from_pixel.apply(DVec2::new(1200.0, 300.0));
            assert_eq!(raster.pixel_from_screen(beyond), None);
        }
    }

    #[test]
    fn flat_and_folded_rasters_are_not_regular() {
        assert!(whole_screen().is_regular());
        assert!(!raster(Homography(DMat3::ZERO)).is_regular());
        let line = DMat3::from_cols(DVec3::X, DVec3::X * 2.0, DVec3::Z);
        assert!(!raster(Homography(line)).is_regular());
        let folded = DMat3::from_cols(DVec3::new(0.001, 0.0, -0.002), DVec3::Y * 0.001, DVec3::Z);
        assert!(!raster(Homography(folded)).is_regular());
    }

    #[test]
    fn a_mirrored_raster_is_regular() {
        let mirrored = Homography::of_rectangle(SIZE, DVec2::new(0.8, -0.45), DVec2::new(-1.6, 0.9));
        assert!(raster(mirrored).is_regular());
        assert!(raster(mirrored).covers(DVec2::ZERO));
    }
}
