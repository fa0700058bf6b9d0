//! How large the files of a calibration may be.

/// Pixels of a map, at most: 4096 × 4096, more than any projector has.
pub const MOST_MAP_PIXELS: u32 = 1 << 24;
/// Points along an edge of a mesh, at most.
pub const MOST_MESH_ALONG: u32 = 1025;
