//! Enhancers: what changes samples by where they lie and from where they are seen.

mod band;
mod band_picker;
mod chain;
mod clip_plane;
mod layer_opacity;
mod link;
mod probe;

pub use band_picker::BandPicker;
pub use chain::{Chain, LinkState, Place};
pub use clip_plane::ClipPlane;
pub use layer_opacity::LayerOpacity;
pub use link::{Constants, constants};
pub use probe::Probe;
