//! The cells of a brick, which let rays skip empty space inside it.

/// Texels along the edge of a cell.
pub const CELL_EDGE: usize = 4;
/// Cells along the edge of a brick.
pub const CELLS_ACROSS: usize = 8;
/// Words of 32 bits that hold a brick's 8³ cells: cell (x, y, z) is bit (z · 8 + y) · 8 + x. A bit is set where any
/// texel within two texels of the cell shows anything. A ray that passes through a cell then finds nothing within one
/// voxel of it, interpolation included.
pub const CELL_WORDS: usize = CELLS_ACROSS * CELLS_ACROSS * CELLS_ACROSS / 32;
