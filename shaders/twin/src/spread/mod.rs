//! What samples of coarse levels stand for.

mod level;
mod three;

pub use level::sample_over;
pub(crate) use level::with_outside;
