//! The way from the canonical raster to a projector's own.

use super::{CanonicalRaster, Raster};
use crate::Homography;
use glam::DVec2;

/// A raster whose corners lie this near to those of the canonical one (canonical pixels) is the canonical one: its
/// calibration carries rounding of about 1e-12.
const ALIGNED_PX: f64 = 1e-9;

/// Where a projector's pixels fall on the canonical raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// Pixel coordinates of the projector to canonical ones.
    pub canonical_from_pixel: Homography,
}

impl Warp {
    /// From a canonical raster to a projector's; None where they coincide, so that there is nothing to warp.
    pub fn between(canonical: &CanonicalRaster, raster: &Raster) -> Option<Self> {
        let map = Homography(canonical.canonical_from_screen().0 * raster.screen_from_pixel.0);
        let stays = |share: DVec2| {
            let corner = share * raster.size();
            (map.apply(corner) - corner).length() <= ALIGNED_PX
        };
        let is_aligned = (raster.width, raster.height) == (canonical.width, canonical.height)
            && [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].into_iter().all(stays);
        (!is_aligned).then_some(Self { canonical_from_pixel: map })
    }
}

impl CanonicalRaster {
    /// The pixel-to-screen map of a projector that is reached by a warp, or by none.
    pub fn screen_from_pixel(&self, warp: Option<&Warp>) -> Homography {
        let screen_from_canonical = self.screen_from_canonical();
        match warp {
            Some(warp) => Homography(screen_from_canonical.0 * warp.canonical_from_pixel.0),
            None => screen_from_canonical,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Display;
    use proptest::prelude::*;

    const SIZE: DVec2 = DVec2::new(0.6, 0.45);
    const CANONICAL: CanonicalRaster = CanonicalRaster { width: 320, height: 240, size_m: SIZE };

    fn raster(width: u32, height: u32, screen_from_pixel: Homography) -> Raster {
        Raster { width, height, screen_from_pixel, output: None }
    }

    #[test]
    fn presets_are_not_warped_and_keep_their_maps_to_the_bit() {
        for (name, _) in crate::presets() {
            let display = Display::load(name).unwrap();
            let canonical = display.canonical_raster();
            for projector in &display.projectors {
                assert_eq!(projector.warp(&canonical), None);
                assert_eq!(canonical.screen_from_pixel(None), projector.raster.screen_from_pixel);
            }
        }
    }

    #[test]
    fn other_sizes_parts_and_mirrors_are_warped() {
        let whole = |width, height| {
            let pixels = DVec2::new(f64::from(width), f64::from(height));
            raster(width, height, Homography::of_rectangle(pixels, -SIZE / 2.0, SIZE))
        };
        assert_eq!(Warp::between(&CANONICAL, &whole(320, 240)), None);
        assert!(Warp::between(&CANONICAL, &whole(160, 120)).is_some());
        let half = Homography::of_rectangle(CANONICAL.size(), -SIZE / 2.0, SIZE * DVec2::new(0.5, 1.0));
        assert!(Warp::between(&CANONICAL, &raster(320, 240, half)).is_some());
        let mirrored = Homography::of_rectangle(
            CANONICAL.size(),
            SIZE * DVec2::new(0.5, -0.5),
            SIZE * DVec2::new(-1.0, 1.0),
        );
        assert!(Warp::between(&CANONICAL, &raster(320, 240, mirrored)).is_some());
    }

    proptest! {
        #[test]
        fn a_warp_and_the_canonical_map_are_the_projector_s_own_map(
            j in prop::array::uniform8(-0.05f64..0.05), x in 0.0..320.0, y in 0.0..240.0,
        ) {
            let corner = |sx: f64, sy: f64, i: usize| DVec2::new(sx * 0.3 + j[i], sy * 0.225 + j[i + 1]);
            let corners = [corner(-1.0, 1.0, 0), corner(1.0, 1.0, 2), corner(1.0, -1.0, 4), corner(-1.0, -1.0, 6)];
            let own = raster(320, 240, Homography::of_corners(CANONICAL.size(), corners).unwrap());
            let warp = Warp::between(&CANONICAL, &own);
            let composed = CANONICAL.screen_from_pixel(warp.as_ref());
            let pixel = DVec2::new(x, y);
            let distance = (composed.apply(pixel) - own.screen_from_pixel.apply(pixel)).length();
            prop_assert!(distance < 1e-14, "{distance}");
        }
    }
}
