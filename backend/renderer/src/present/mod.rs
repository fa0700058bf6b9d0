//! From what was cast to what is shown: pixels that were not cast are reconstructed, and colours become the codes of a projector.

mod classes;
mod codes;
mod finish;
mod reconstruct;

pub use classes::{Classes, lattice_of};
pub use codes::screen_image;
pub use finish::Finisher;
pub use reconstruct::{Raster, Thresholds, reconstruct};
