//! One projector's rays, as [`ViewBlock`] holds them for a kernel.

use super::vector::Vec3;
use display_config::{BeamLaw, CanonicalRaster, Projector};
use layout::ViewBlock;

/// See [`ViewBlock`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectorRays<F> {
    /// Columns of the pixel-to-screen homography.
    pub screen_from_pixel: [Vec3<F>; 3],
    /// A, B of Ox = A + B Sx, then Oy and Oz, metres.
    pub beam: [F; 4],
    /// Width and height of the raster, pixels.
    pub raster: [u32; 2],
}

impl ProjectorRays<f64> {
    /// The rays of a projector's pixels under a law. They pass through the raster that all projectors share: where the
    /// projector's own does not coincide with it, through the warp between the two.
    pub fn new(canonical: &CanonicalRaster, projector: &Projector, law: &BeamLaw) -> Self {
        let h = canonical.screen_from_pixel(projector.warp(canonical).as_ref()).0;
        let raster = &projector.raster;
        let origin = law.origin(glam::DVec2::ZERO);
        Self {
            screen_from_pixel: [h.x_axis, h.y_axis, h.z_axis].map(|column| Vec3(column.to_array())),
            beam: [law.a(), law.b(), origin.y, origin.z],
            raster: [raster.width, raster.height],
        }
    }

    /// The same rays in f32, as a kernel reads them.
    pub fn rounded(&self) -> ProjectorRays<f32> {
        ProjectorRays {
            screen_from_pixel: self.screen_from_pixel.map(Vec3::rounded),
            beam: self.beam.map(|x| x as f32),
            raster: self.raster,
        }
    }
}

/// How the cast pixels of a view are cut into tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    /// Pixels between cast rays: 1 casts them all.
    pub stride: u32,
    /// Tiles along x.
    pub across: u32,
    /// Tiles to cast.
    pub tiles: u32,
}

impl ProjectorRays<f32> {
    /// The uniform block of this view.
    pub fn block(&self, tiling: &Tiling) -> ViewBlock {
        let column = |v: Vec3<f32>| [v.0[0], v.0[1], v.0[2], 0.0];
        ViewBlock {
            screen_from_pixel: self.screen_from_pixel.map(column),
            beam: self.beam,
            raster: [self.raster[0], self.raster[1], tiling.stride, tiling.across],
            extent: [tiling.tiles, 0, 0, 0],
        }
    }
}
