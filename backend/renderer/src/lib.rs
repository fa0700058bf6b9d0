//! The renderer of one back-end: working set, brick cache, devices, and what becomes of its pictures.

pub mod device;
pub mod output;
mod render;
pub mod working_set;

pub use render::{RenderError, Renderer};
