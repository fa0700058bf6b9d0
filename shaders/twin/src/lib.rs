//! The kernels' twin in Rust, generic over f32 and f64: the same algorithm over the same cut and bricks.
//!
//! At f32 it agrees with the kernels to rounding and is what the CPU device runs; at f64 it shows what rounding
//! costs. Twins take long to compile, so this crate holds nothing else, and those in f32 are compiled here: see
//! [`cast_pixels`]. Files share their stem with the WGSL module they mirror. They differ in four places: bricks are lists of
//! codes instead of parts of one texture, so a point to sample is relative to its brick; a table entry is read as
//! f32 and widened; enhancers, which change eight rays at a time, work out both sides of what the kernel branches on and
//! choose; and where the composer puts one module or another into a slot, the twin has generics for shading and
//! compositing and branches for the rest, of which twins for plain scenes have none: see [`kernel`].

mod along;
mod brick;
mod cast;
mod casting;
mod cell;
pub mod composite;
pub mod debug;
pub mod enhance;
mod features;
mod four;
pub mod gradient;
pub mod importance;
pub mod kernel;
pub mod levels;
mod material;
mod observer;
mod outcome;
mod pixels;
mod placement;
mod projector;
pub mod ray;
pub mod real;
pub mod refine;
pub mod sample;
mod scene;
pub mod shade;
mod short;
pub mod spread;
pub mod tables;
pub mod traverse;
pub mod vector;
mod volume;
mod way;

pub use cast::cast_in_full;
pub use casting::Casting;
pub use cell::{Cell, RayOnItsWay, add_cell, still_to_come};
pub use observer::{FeedbackCell, Observer};
pub use outcome::Cast;
pub use pixels::{cast_pixels, cast_short};
pub use placement::Placement;
pub use projector::{Lattice, ProjectorRays, Tiling};
pub use real::Real;
pub use scene::SceneNumbers;
pub use short::ShortRay;
pub use volume::Volume;
