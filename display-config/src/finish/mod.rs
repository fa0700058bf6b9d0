//! What becomes of a picture on its way to the codes that one projector is sent: the calibration beyond its raster.
//!
//! The stages come in this order, each left out where it is the identity: warp by a mesh, blend, black level, transfer
//! curve, dither.

mod fault;
mod limits;
mod map;
mod mesh;
mod transfer;

pub use fault::MapFault;
pub use limits::{MOST_MAP_PIXELS, MOST_MESH_ALONG};
pub use map::LightMap;
pub use mesh::Mesh;
pub use transfer::{Response, Transfer};

use serde::{Deserialize, Serialize};

/// The stages of one projector.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Finish {
    /// Where its pixels fall on the screen; None where they fall as its raster says.
    pub mesh: Option<Mesh>,
    /// A factor of linear light for each pixel.
    pub blend: Option<LightMap>,
    /// The light that black is lifted to.
    pub black: Option<BlackLevel>,
    /// From linear light to codes.
    pub transfer: Transfer,
    /// Whether codes are dithered rather than rounded.
    pub is_dithered: bool,
}

/// The light that black is lifted to, from 0 to 1: `out = black + (1 − black) · in`, as MPCDI's β.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum BlackLevel {
    /// The same for all pixels: red, green, blue.
    Level([f32; 3]),
    /// For each pixel its own, the same for all channels.
    Map(LightMap),
}
