//! Gradients of the scalar over levels of detail.

mod central;
mod detail;

pub use central::LEAST_SQUARE;
pub use detail::Gradients;
