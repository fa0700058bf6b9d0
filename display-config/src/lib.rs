//! What a light-field display is: its geometry, its projectors, its ray model.

mod display;
mod homography;

pub use display::{Display, Projector, Raster};
pub use homography::Homography;
