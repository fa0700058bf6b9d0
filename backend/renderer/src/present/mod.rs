//! From what was cast to what is shown: pixels that were not cast are reconstructed, and colours become the codes of a projector.

mod classes;
mod ease;
mod finish;
mod layers;
mod reconstruct;
mod resample;
mod show;

pub use classes::{Classes, lattice_of};
pub use ease::ease;
#[cfg(feature = "gpu")]
pub use finish::FinishTables;
pub use finish::Finisher;
pub use layers::Layers;
#[cfg(feature = "gpu")]
pub use reconstruct::{Pass, passes};
pub use reconstruct::{Raster, Thresholds};
pub use resample::{Bends, resampled};
pub use show::{Show, reconstruct};
