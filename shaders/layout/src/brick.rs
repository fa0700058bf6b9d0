//! The geometry of a brick: the samples it stores, those that are its own, and the cells that let rays pass over
//! empty space inside it.

/// Stored samples along an edge.
pub const EDGE: usize = 32;
/// Samples of overlap on each side.
pub const OVERLAP: usize = 2;
/// Own voxels along an edge: 28.
pub const OWN_EDGE: usize = EDGE - 2 * OVERLAP;
/// Stored samples.
pub const VOXELS: usize = EDGE * EDGE * EDGE;
/// Texels along the edge of a cell.
pub const CELL_EDGE: usize = 4;
/// Cells along the edge of a brick; a power of two.
pub const CELLS_ACROSS: usize = EDGE / CELL_EDGE;
/// Words of 32 bits that hold a brick's 8³ cells: cell (x, y, z) is bit (z · 8 + y) · 8 + x. A bit is set where any
/// texel within two texels of the cell shows anything. A ray that passes through a cell then finds nothing within one
/// voxel of it, interpolation included.
pub const CELL_WORDS: usize = CELLS_ACROSS * CELLS_ACROSS * CELLS_ACROSS / 32;
