//! What kernels of row planes are told of the grid on the planes.

use crate::TILE_EDGE;
use bytemuck::{Pod, Zeroable};

/// Columns that a workgroup takes.
pub const PLANE_COLUMNS: u32 = 64;

/// The grid that some views share, and the pixels that see it; A of each view follows it in its buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FanBlock {
    /// Screen x of the left edge of pixel 0 and metres per pixel, screen y of row 0's edge and metres per row.
    pub raster: [f32; 4],
    /// B, Vy and Vz.
    pub way: [f32; 3],
    /// The largest error of a cell's light that distances between samples may make.
    pub most_spacing_error: f32,
    /// The same that means may make, of what is still seen.
    pub most_mean_error: f32,
    /// Views.
    pub views: u32,
    /// Blocks of [`TILE_EDGE`] pixels of a row.
    pub blocks: u32,
    /// How often the rows of the bands have been swept so far.
    pub sweeps: u32,
    /// Rows between those that are cast.
    pub step: u32,
    /// The first of these.
    pub first_row: u32,
    /// Rows there are.
    pub rows: u32,
    /// Bands that are cast.
    pub bands: u32,
}

/// A row of tiles, of all views.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct PlaneBand {
    /// Its number from the top.
    pub at: u32,
    /// Its first layer among all that are listed.
    pub first_layer: u32,
    /// Its layers, from the front to the back.
    pub layers: u32,
    /// Where the first column of its first row is kept.
    pub first_column: u32,
    /// Columns of each row, those of all layers.
    pub columns: u32,
    /// Where the first block of its first row is kept.
    pub first_block: u32,
    /// Blocks of each row.
    pub blocks: u32,
    /// Fills 32 bytes.
    pub padding: u32,
}

/// The columns at one depth of a band's planes, and what lies between it and the next.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PlaneLayer {
    /// Its depth and that of the next, metres.
    pub z: [f32; 2],
    /// Where its slab begins, and where it ends.
    pub slab_z: [f32; 2],
    /// Columns per pixel.
    pub phases: f32,
    /// The number of its first column, counted from the left edge of pixel 0; whole blocks of pixels away from it.
    pub first: i32,
    /// Columns.
    pub width: u32,
    /// Where the first is kept in a row.
    pub at: u32,
    /// Where the first block is.
    pub block_at: u32,
    /// 1 where there is a cell between it and the next, else 0.
    pub has_cell: u32,
    /// The same of the one before it.
    pub has_cell_before: u32,
    /// Fills 48 bytes.
    pub padding: u32,
}

impl PlaneLayer {
    /// Blocks of pixels that its columns make.
    pub fn blocks(&self) -> u32 {
        self.width / (TILE_EDGE * self.phases as u32)
    }
}

/// How much (τ c, τ) and importance vary from the lowest scalar to a border of the tables' cells.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PlaneVariation {
    /// Of the channel that varies most.
    pub most: f32,
    /// Of importance.
    pub importance: f32,
    /// Fills 16 bytes.
    pub padding: [f32; 2],
    /// Of each.
    pub each: [f32; 4],
    /// (τ c, τ) at the border.
    pub value: [f32; 4],
}

/// What was found in a row of tiles.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct PlaneFound {
    /// Samples of the volume that all views share.
    pub samples: u32,
    /// Not 0 where a node on the way was too coarse.
    pub is_missing: u32,
}
