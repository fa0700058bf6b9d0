//! Capacity-constrained points with a Gaussian, as STE casts and reconstructs, against lattices of pixels that are filled.

mod kernels;
mod painter;
mod patterns;
mod plan;
mod played;
mod shots;
mod stills;
mod strip;

pub use played::compare as played;
pub use stills::compare as stills;
