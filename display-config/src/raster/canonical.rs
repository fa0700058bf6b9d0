//! The canonical raster: rows and columns on the screen that all projectors of a display share.

use crate::Homography;
use glam::{DMat3, DVec2, DVec3};

/// Pixels that fill the screen, rows from the top; pixel centres at integer + 0.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanonicalRaster {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Size of the screen, metres.
    pub size_m: DVec2,
}

impl CanonicalRaster {
    /// Its size in pixels.
    pub fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// Screen point (metres, x right, y up) of the centre of pixel (x, y), y down.
    pub fn point(&self, x: u32, y: u32) -> DVec2 {
        let across = (f64::from(x) + 0.5) / f64::from(self.width) - 0.5;
        let up = 0.5 - (f64::from(y) + 0.5) / f64::from(self.height);
        DVec2::new(across, up) * self.size_m
    }

    /// Canonical pixel coordinates to screen metres.
    pub fn screen_from_canonical(&self) -> Homography {
        Homography::of_rectangle(self.size(), -self.size_m / 2.0, self.size_m)
    }

    /// Screen metres to canonical pixel coordinates.
    pub fn canonical_from_screen(&self) -> Homography {
        let per_metre = self.size() / self.size_m;
        Homography(DMat3::from_cols(
            DVec3::new(per_metre.x, 0.0, 0.0),
            DVec3::new(0.0, -per_metre.y, 0.0),
            (self.size() / 2.0).extend(1.0),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixel_centres_are_where_the_map_says() {
        let raster = CanonicalRaster { width: 320, height: 240, size_m: DVec2::new(0.6, 0.45) };
        for (x, y) in [(0, 0), (319, 239), (17, 200)] {
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let on_screen = raster.screen_from_canonical().apply(pixel);
            assert!((on_screen - raster.point(x, y)).length() < 1e-15);
            assert!((raster.canonical_from_screen().apply(on_screen) - pixel).length() < 1e-12);
        }
    }
}
