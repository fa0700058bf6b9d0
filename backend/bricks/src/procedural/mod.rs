//! Volumes made from formulas: known everywhere, of any size, with value, gradient and bounds as truth.

mod field;
#[cfg(test)]
mod field_tests;
mod interval;
mod marschner_lobb;
mod shells;
mod sparse_vessels;
mod tube;
mod volume;

pub use field::{FIELD_NAMES, Field, field_named};
pub use marschner_lobb::MarschnerLobb;
pub use shells::Shells;
pub use sparse_vessels::SparseVessels;
pub use volume::ProceduralVolume;
