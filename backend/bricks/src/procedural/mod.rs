//! Volumes made from formulas: known everywhere, of any size, with value, gradient and bounds as truth.

mod field;
#[cfg(test)]
mod field_tests;
mod interval;
mod marschner_lobb;
mod named;
mod shells;
mod sparse_vessels;
mod tube;
mod volume;

pub use field::Field;
pub use marschner_lobb::MarschnerLobb;
pub use named::{FIELD_NAMES, field_named};
pub use shells::Shells;
pub use sparse_vessels::SparseVessels;
pub use volume::ProceduralVolume;
