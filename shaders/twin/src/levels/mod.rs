//! Samples over levels of detail.

mod level;
mod three;
mod weights;

pub use level::Level;
pub use three::Brick;
pub(crate) use weights::parents_share;
