//! From what was cast to what is shown: pixels that were not cast are reconstructed, and colours become codes.

mod classes;
mod codes;
mod reconstruct;

pub use classes::{Classes, lattice_of};
pub use codes::screen_image;
pub use reconstruct::{Raster, Thresholds, reconstruct};
