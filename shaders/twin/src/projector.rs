//! One projector's rays, as [`ViewBlock`] holds them for a kernel.

use super::{Real, vector::Vec3};
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

    /// The same rays in the numbers of a twin: in f32 as a kernel reads them.
    pub fn rounded<F: Real>(&self) -> ProjectorRays<F> {
        ProjectorRays {
            screen_from_pixel: self.screen_from_pixel.map(Vec3::rounded),
            beam: self.beam.map(F::of),
            raster: self.raster,
        }
    }
}

/// Which pixels of a raster are cast: those at `first`, and at every `step` from there, along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Pixels between cast rays.
    pub step: [u32; 2],
    /// Column and row of the first cast pixel, each less than the step.
    pub first: [u32; 2],
}

impl Lattice {
    /// All pixels.
    pub const ALL: Self = Self { step: [1; 2], first: [0; 2] };
}

/// How the cast pixels of a view are cut into tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    /// Which pixels these are.
    pub lattice: Lattice,
    /// Tiles along x.
    pub across: u32,
    /// Where the first pixel of the view's picture lies among those of all.
    pub first_pixel: u32,
}

impl ProjectorRays<f32> {
    /// The block of this view.
    pub fn block(&self, tiling: &Tiling) -> ViewBlock {
        let column = |v: Vec3<f32>| [v.0[0], v.0[1], v.0[2], 0.0];
        let Lattice { step: [step_x, step_y], first: [first_x, first_y] } = tiling.lattice;
        ViewBlock {
            screen_from_pixel: self.screen_from_pixel.map(column),
            beam: self.beam,
            raster: [self.raster[0], self.raster[1], tiling.across, tiling.first_pixel],
            lattice: [step_x, step_y, first_x, first_y],
        }
    }
}
