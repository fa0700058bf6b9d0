//! What a light-field display is: its geometry, its projectors, its ray model.

mod assignment;
mod display;
mod error;
#[cfg(test)]
mod fixed_seed;
mod homography;
mod parse;
mod preset;
mod projector;
mod raster;
mod ray;

pub use display::Display;
pub use error::{Clip, ConfigError, Place, RayError};
pub use homography::Homography;
pub use preset::presets;
pub use projector::Projector;
pub use raster::{COVER_TOLERANCE_PX, Raster, RasterInverse};
pub use ray::{BeamLaw, Ray};
