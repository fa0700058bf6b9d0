//! Rasters: the one that a display's projectors have in common, and each projector's own.

mod calibrated;
mod canonical;
mod warp;

pub(crate) use calibrated::is_strictly_convex;
pub use calibrated::{COVER_TOLERANCE_PX, Raster, RasterInverse};
pub use canonical::CanonicalRaster;
pub use warp::Warp;

/// Pixels of a picture, at most: 8192 × 8192. In linear colours that is a gibibyte, which one message may still carry.
pub const MOST_PIXELS: u32 = 1 << 26;
/// Pixels along an edge, at most: more than any projector or texture has.
pub(crate) const MOST_PIXELS_ALONG: u32 = 1 << 14;
