//! The chain of enhancers along one ray.

mod band_picker;
mod chain;
mod clip_plane;
mod layer_opacity;
mod probe;

pub use chain::{Chain, Place, Zone, Zones};
