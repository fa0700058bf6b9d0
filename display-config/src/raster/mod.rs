//! Rasters: the one that a display's projectors have in common, and each projector's own.

mod calibrated;
mod canonical;
mod warp;

pub(crate) use calibrated::is_strictly_convex;
pub use calibrated::{COVER_TOLERANCE_PX, Raster, RasterInverse};
pub use canonical::CanonicalRaster;
pub use warp::Warp;
