//! Enhancers: what changes samples by where they lie and from where they are seen.

mod band;
mod band_picker;
mod chain;
mod clip_plane;
mod hooks;
mod layer_opacity;
mod link;
mod place;
mod probe;

pub use chain::Chain;
pub use hooks::constants;
pub use place::Segment;
