//! Tools, lines and labels, drawn over the picture of each projector where the rays of its pixels meet them.
//!
//! Every shape goes to the raster through the inverse of the projector's own rays, so that marks and volume agree at every η. That
//! is a crossed-slits projection, which bends straight edges: they are subdivided until no piece is off by more than a twentieth
//! of a pixel.
//!
//! | file | what it is |
//! | --- | --- |
//! | `view` | where points land in a projector's picture |
//! | `polygon` | polygons cut by lines and planes, and their hulls |
//! | `stroke`, `sheet` | lines and surfaces as polygons of pixels |
//! | `letters` | text as outlines |
//! | `fill` | polygons as shares of pixels |
//! | `depth`, `fragment` | where rays meet marks, and marks among what else they meet |
//! | `pen` | all of a frame's marks |

mod depth;
mod fill;
mod fragment;
mod letters;
mod pen;
mod polygon;
mod sheet;
mod stroke;
mod view;

pub use fragment::{Fragment, FragmentPlace};
pub use letters::unknown_characters;
pub use pen::Pen;
pub use view::View;
