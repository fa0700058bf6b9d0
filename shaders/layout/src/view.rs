//! What a kernel must know of one projector's view.

use bytemuck::{Pod, Zeroable};

/// Rays are cast in square tiles of this many pixels along an edge: one workgroup each.
pub const TILE_EDGE: u32 = 8;
/// Short rays are cast in rows of this many: one workgroup each.
pub const SHORT_RAYS: u32 = 64;
/// Tiles are tallied in rows of this many: one workgroup each.
pub const TALLIED_TILES: u32 = 64;
/// Set in a pixel's count of samples where its ray met a node that is too coarse.
pub const MISSING: u32 = 0x8000_0000;
/// Set there if the driver left a loop before the ray's end: some do so with loops that go round often.
pub const CUT: u32 = 0x4000_0000;
/// The bits there that are the number of samples.
pub const SAMPLE_COUNT: u32 = CUT - 1;

/// What the rays of [`TALLIED_TILES`] tiles counted.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct TileTally {
    /// Samples of all their rays: less than 2³² while a ray takes less than a million.
    pub samples: u32,
    /// A bit for each of them, set where one of its rays met a node that is too coarse.
    pub missing: [u32; 2],
    /// Rays that the driver left before their end.
    pub cut: u32,
}

impl TileTally {
    /// Whether a ray of a tile, by its place among them, met a node that is too coarse.
    pub fn is_missing(&self, place: usize) -> bool {
        self.missing[place / 32] >> (place % 32) & 1 != 0
    }
}

/// One of the views that a dispatch casts. Every member fills 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ViewBlock {
    /// Columns of the pixel-to-screen homography; the fourth number of each is unused.
    pub screen_from_pixel: [[f32; 4]; 3],
    /// A, B of the ray law Ox = A + B Sx, then Oy and Oz; metres.
    pub beam: [f32; 4],
    /// Width and height of the raster in pixels, then tiles along x, then where its first pixel lies among all.
    pub raster: [u32; 4],
    /// Pixels between cast rays along x and y, then column and row of the first of them.
    pub lattice: [u32; 4],
}
