//! The names of procedural volumes.

/// What names of procedural volumes begin with.
pub(super) const PROCEDURAL: &str = "procedural:";
/// Names that may follow `procedural:`.
pub const PROCEDURAL_NAMES: [&str; 3] = ["shells", "marschner-lobb", "sparse-vessels"];
