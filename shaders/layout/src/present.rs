//! What the kernels that present must know of a picture.

use bytemuck::{Pod, Zeroable};

/// Pairs of neighbours that a missing pixel is made from, at most.
pub const MOST_PAIRS: usize = 3;
/// In the table of a warp, both numbers of a pixel that sees none of the picture.
pub const NOWHERE: f32 = -1e9;
/// Codes of a channel.
pub const CODES: usize = 256;
/// Numbers of a channel's transfer curve: the lights at which the code rises, then those of all codes.
pub const CURVE_NUMBERS: usize = 2 * CODES - 1;

/// Pixels of a row whose codes are whole words.
pub const CODED_PIXELS: u32 = 4;

/// Bits of a coordinate that matter to the dither: its pattern repeats after 32 pixels.
pub const DITHER_BITS: u32 = 5;

/// Stages of a finish, as bits of [`PresentBlock::stages`].
pub const HAS_WARP: u32 = 1;
/// There is a factor for each pixel.
pub const HAS_BLEND: u32 = 2;
/// There is a black level for each pixel.
pub const HAS_BLACK_MAP: u32 = 4;
/// Codes are dithered, not rounded.
pub const IS_DITHERED: u32 = 8;

/// The uniform block of one pass over a picture. Every member fills 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PresentBlock {
    /// Width and height of the raster, pixels; the classes of pixels to make, a bit each; pairs of neighbours.
    pub raster: [u32; 4],
    /// Of each pair of neighbours the way to one, pixels along x and y; the other lies opposite.
    pub steps: [[i32; 4]; MOST_PAIRS],
    /// Between these two disorders, linear colour, a pixel goes over from time to space; then the most that any number of a
    /// pixel may change by.
    pub numbers: [f32; 4],
    /// Whether anything was shown before, 0 or 1; the stages of the finish.
    pub stages: [u32; 4],
    /// The black level of red, green and blue.
    pub black: [f32; 4],
}

/// Pixels with marks are listed in rows of this many.
pub const MARKED_ACROSS: u32 = 1024;

/// One thing that is laid into a pixel, see the renderer's `present::Layers`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Layer {
    /// What the pixel's ray meets before it: linear colour, premultiplied, and opacity.
    pub before: [f32; 4],
    /// Its own linear colour.
    pub rgb: [f32; 3],
    /// How much of the pixel it covers.
    pub opacity: f32,
}

/// A pixel with the layers that are laid into it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct MarkedPixel {
    /// Its place in the picture, row by row.
    pub pixel: u32,
    /// Its first layer.
    pub first: u32,
    /// How many there are.
    pub count: u32,
}

/// The uniform block of a picture that is painted into a window. Every member fills 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct PaintBlock {
    /// The window's pixel at the top left of the picture.
    pub place: [i32; 4],
    /// The picture's pixel that is seen there; bytes of a row of its codes.
    pub source: [i32; 4],
    /// The ways in the picture of a step to the right and of one down in the window.
    pub steps: [i32; 4],
}
