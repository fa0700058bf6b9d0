//! The names of procedural volumes, which are those of their fields.

pub use bricks::procedural::FIELD_NAMES as PROCEDURAL_NAMES;
pub(crate) use volumes::PROCEDURAL_PREFIX;
