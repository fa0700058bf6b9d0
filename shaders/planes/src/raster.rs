//! The raster that calibrated views have in common, and the way from it to the raster of each.

use glam::{DMat3, DVec2, DVec3};
use twin::ProjectorRays;
use twin::vector::Vec3;

/// Pixels of the common raster around the views' own: the cubic that resamples it reaches so far.
const MARGIN: f64 = 2.0;

/// The common raster has at most so many times the pixels of the largest one: more would cost more than sharing saves.
const MOST_TIMES_AS_LARGE: f64 = 6.0;

/// From pixels of a view's own raster to those of the raster it is resampled from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterWarp {
    /// Pixel coordinates, centres at integer + 0.5; projective.
    common_from_pixel: DMat3,
    /// Pixels of the view's own raster along x and y.
    pub raster: [u32; 2],
    /// Pixels of the common raster along x and y.
    pub common: [u32; 2],
}

impl RasterWarp {
    /// Where the centre of pixel (x, y) lies on the common raster, pixels; the centre of its first one is at 0.5.
    #[inline]
    pub fn place(&self, x: u32, y: u32) -> [f64; 2] {
        self.place_of(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).to_array()
    }

    fn place_of(&self, pixel: DVec2) -> DVec2 {
        let image = self.common_from_pixel * pixel.extend(1.0);
        image.truncate() / image.z
    }

    /// The part of the common raster that it looks at.
    pub(crate) fn footprint(&self) -> Footprint {
        let [width, height] = self.raster.map(f64::from);
        let corners =
            [DVec2::ZERO, DVec2::new(width, 0.0), DVec2::new(width, height), DVec2::new(0.0, height)];
        Footprint { corners: corners.map(|corner| self.place_of(corner)) }
    }
}

/// A convex quadrilateral of the common raster.
#[derive(Clone, Debug)]
pub(crate) struct Footprint {
    corners: [DVec2; 4],
}

impl Footprint {
    /// The pixels of a row that a view within it looks at, from the first to before the last. None where there is none.
    pub(crate) fn columns(&self, row: u32) -> Option<[f64; 2]> {
        let middle = f64::from(row) + 0.5;
        let [above, below] = [middle - MARGIN, middle + MARGIN];
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for i in 0..4 {
            let [a, b] = [self.corners[i], self.corners[(i + 1) % 4]];
            let shares = [above, below].map(|y| (y - a.y) / (b.y - a.y));
            for t in [0.0].into_iter().chain(shares.into_iter().filter(|t| (0.0..1.0).contains(t))) {
                let point = a.lerp(b, t);
                if point.y >= above - 1e-9 && point.y <= below + 1e-9 {
                    (low, high) = (low.min(point.x), high.max(point.x));
                }
            }
        }
        (low <= high).then(|| [(low - MARGIN).floor(), (high + MARGIN).ceil()])
    }
}

/// A raster upright on the screen: screen x of its left edge and metres per pixel, screen y of its top edge and of a row.
struct Upright {
    x: [f64; 2],
    y: [f64; 2],
    pixels: [u32; 2],
}

/// Rays of an upright raster which covers those of some views, and resolves on the screen all that they do; and the way from it to
/// each of them. None if it would be too large.
pub(crate) fn in_common(views: &[ProjectorRays<f32>]) -> Option<(Vec<ProjectorRays<f32>>, Vec<RasterWarp>)> {
    let raster = common_raster(views)?;
    let Upright { x: [left, across], y: [top, down], pixels } = raster;
    let screen_from_common = [
        Vec3([across as f32, 0.0, 0.0]),
        Vec3([0.0, down as f32, 0.0]),
        Vec3([left as f32, top as f32, 1.0]),
    ];
    // As rays are cast: in f32.
    let [across, down, corner] = screen_from_common.map(|column| column.0.map(f64::from));
    let common_from_screen = DMat3::from_cols(
        DVec3::new(1.0 / across[0], 0.0, 0.0),
        DVec3::new(0.0, 1.0 / down[1], 0.0),
        DVec3::new(-corner[0] / across[0], -corner[1] / down[1], 1.0),
    );
    let rays = |view: &ProjectorRays<f32>| ProjectorRays {
        screen_from_pixel: screen_from_common,
        raster: pixels,
        ..*view
    };
    let warp = |view: &ProjectorRays<f32>| RasterWarp {
        common_from_pixel: common_from_screen * screen_from_pixel(view),
        raster: view.raster,
        common: pixels,
    };
    Some((views.iter().map(rays).collect(), views.iter().map(warp).collect()))
}

fn screen_from_pixel(view: &ProjectorRays<f32>) -> DMat3 {
    let [x, y, z] = view.screen_from_pixel.map(|column| DVec3::from_array(column.0.map(f64::from)));
    DMat3::from_cols(x, y, z)
}

fn common_raster(views: &[ProjectorRays<f32>]) -> Option<Upright> {
    let (mut low, mut high, mut pitch) = (DVec2::MAX, DVec2::MIN, DVec2::MAX);
    let mut largest = 0.0f64;
    for view in views {
        let map = screen_from_pixel(view);
        let size = DVec2::from_array(view.raster.map(f64::from));
        largest = largest.max(size.x * size.y);
        for share in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE, DVec2::splat(0.5)] {
            let image = map * (share * size).extend(1.0);
            let point = image.truncate() / image.z;
            // How the screen point moves from pixel to pixel, along x and along y.
            let along = |column: DVec3| (column.truncate() - point * column.z) / image.z;
            let [x, y] = [along(map.x_axis), along(map.y_axis)];
            // Frequencies of up to half a period a pixel, both ways, are of up to half a period in these distances.
            let area = x.perp_dot(y).abs();
            pitch = pitch.min(DVec2::new(area / (x.y.abs() + y.y.abs()), area / (x.x.abs() + y.x.abs())));
            (low, high) = (low.min(point), high.max(point));
        }
    }
    let pixels = ((high - low) / pitch).ceil() + 2.0 * (MARGIN + 1.0);
    let is_sensible = pixels.is_finite() && pixels.x * pixels.y <= MOST_TIMES_AS_LARGE * largest.max(1024.0);
    is_sensible.then(|| Upright {
        x: [low.x - (MARGIN + 1.0) * pitch.x, pitch.x],
        y: [high.y + (MARGIN + 1.0) * pitch.y, -pitch.y],
        pixels: [pixels.x as u32, pixels.y as u32],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A raster of 80 × 60 pixels, 8 mm each, turned by an angle and moved, with a keystone.
    fn turned(angle: f64, aside: f64, keystone: f64) -> ProjectorRays<f32> {
        let (sin, cos) = angle.sin_cos();
        let size = 0.008;
        let columns = [
            [size * cos, size * sin, keystone],
            [size * sin, -size * cos, 0.0],
            [aside - 40.0 * size, 30.0 * size, 1.0],
        ];
        ProjectorRays {
            screen_from_pixel: columns.map(|column| Vec3(column.map(|c| c as f32))),
            beam: [0.1, 1.5, 0.0, 3.0],
            raster: [80, 60],
        }
    }

    fn views() -> Vec<ProjectorRays<f32>> {
        vec![turned(0.05, 0.0, 0.0), turned(-0.2, 0.03, 1e-3), turned(0.0, -0.02, -2e-4)]
    }

    #[test]
    fn a_pixel_s_place_on_the_common_raster_is_its_place_on_the_screen() {
        let own = views();
        let (common, warps) = in_common(&own).unwrap();
        for ((own, common), warp) in own.iter().zip(&common).zip(&warps) {
            for (x, y) in [(0, 0), (79, 0), (79, 59), (0, 59), (33, 20)] {
                let pixel = DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 1.0);
                let truth = screen_from_pixel(own) * pixel;
                let place = DVec2::from_array(warp.place(x, y));
                let found = screen_from_pixel(common) * place.extend(1.0);
                let miss = truth.truncate() / truth.z - found.truncate() / found.z;
                assert!(miss.length() < 1e-9, "{miss}");
                // All that a cubic reads around it is there.
                let size = DVec2::from_array(common.raster.map(f64::from));
                assert!(place.cmpge(DVec2::splat(2.0)).all() && place.cmple(size - 2.0).all(), "{place}");
            }
        }
    }

    #[test]
    fn it_is_as_fine_as_the_finest_pixels_however_they_are_turned() {
        let pitch = |angle: f64| {
            let (common, _) = in_common(&[turned(angle, 0.0, 0.0)]).unwrap();
            common[0].screen_from_pixel[0].0[0]
        };
        assert!((pitch(0.0) - 0.008).abs() < 1e-8);
        // A quarter turn has pixels of the same size, an eighth of a turn frequencies √2 as high.
        assert!((pitch(std::f64::consts::FRAC_PI_2) - 0.008).abs() < 1e-7);
        assert!((pitch(std::f64::consts::FRAC_PI_4) - 0.008 / 2.0f32.sqrt()).abs() < 1e-7);
    }

    #[test]
    fn a_footprint_has_every_pixel_that_is_read() {
        let own = views();
        let (_, warps) = in_common(&own).unwrap();
        for warp in &warps {
            let footprint = warp.footprint();
            for (x, y) in (0..60).flat_map(|y| (0..80).map(move |x| (x, y))) {
                let [u, v] = warp.place(x, y).map(|at| (at - 0.5).floor());
                for row in -1..=2 {
                    let [from, to] = footprint.columns((v as i64 + row) as u32).unwrap();
                    assert!(from <= u - 1.0 && u + 3.0 <= to, "{x} {y}: {u} in {from} to {to}");
                }
            }
            assert_eq!(footprint.columns(100_000), None);
        }
    }

    #[test]
    fn rasters_far_from_each_other_have_none_in_common() {
        assert!(in_common(&[turned(0.0, 0.0, 0.0), turned(0.0, 5.0, 0.0)]).is_none());
    }
}
