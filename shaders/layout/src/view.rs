//! What a kernel must know of one projector's view.

use bytemuck::{Pod, Zeroable};

/// Rays are cast in square tiles of this many pixels along an edge: one workgroup each.
pub const TILE_EDGE: u32 = 8;
/// Short rays are cast in rows of this many: one workgroup each.
pub const SHORT_RAYS: u32 = 64;
/// Tiles are tallied in rows of this many: one workgroup each.
pub const TALLIED_TILES: u32 = 64;
/// Set in a pixel's count of samples where its ray met a node that is too coarse, and in that of a tile.
pub const MISSING: u32 = 0x8000_0000;

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
