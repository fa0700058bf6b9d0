//! What a light-field display is: its geometry, its projectors, its ray model, and the file that describes it.

mod beams;
mod display;
mod error;
mod eye;
mod finish;
#[cfg(test)]
mod fixed_seed;
mod homography;
mod output;
mod parse;
mod preset;
mod projector;
mod raster;
mod ray;
mod resolution;
pub mod text;
mod wiring;
mod zone;

pub use display::{Display, RATES_HZ};
pub use error::{Clip, ConfigError, Place, RayError};
pub use eye::EyeModel;
pub use finish::{BlackLevel, Finish, LightMap, MapFault, Mesh, Response, Transfer};
pub use homography::Homography;
pub use output::{Output, Turn};
pub use preset::presets;
pub use projector::Projector;
pub use raster::{COVER_TOLERANCE_PX, CanonicalRaster, MOST_PIXELS, Raster, RasterInverse, Warp};
pub use ray::{BeamLaw, Ray};
pub use resolution::{Resolution, longest_voxel_edge_m};
pub use wiring::{Origin, Share, Wiring};
