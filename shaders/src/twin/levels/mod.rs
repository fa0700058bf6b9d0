//! Samples over levels of detail.

mod level;
mod three;

pub use level::Level;
pub use three::Brick;
