//! Capacity-constrained points with a Gaussian, as STE casts and reconstructs, against lattices of pixels that are filled.

mod kernels;
mod machine;
mod painter;
mod patterns;
mod plan;
mod played;
mod shots;
mod stills;
mod strip;

pub use played::compare as played;
pub use stills::compare as stills;

/// Rays may go through the middles of so many times as fine a raster, along each axis. It is odd, so that the middles of
/// pixels are among them.
const PARTS: u32 = 5;
