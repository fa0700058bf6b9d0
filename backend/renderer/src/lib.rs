//! The renderer of one back-end: working set, brick cache, devices, and what becomes of its pictures.

mod cache_size;
pub mod device;
pub mod output;
pub mod present;
pub mod refine;
mod render;
pub mod working_set;

pub use render::{RenderError, Renderer};
