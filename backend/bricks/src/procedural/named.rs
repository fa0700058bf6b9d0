//! The fields that have names.

use super::{Field, MarschnerLobb, Shells, SparseVessels};
use glam::DVec3;

/// Names that [`field_named`] knows.
pub const FIELD_NAMES: [&str; 3] = ["shells", "marschner-lobb", "sparse-vessels"];

/// The field of that name for a volume of that extent; None for an unknown name.
pub fn field_named(name: &str, extent: DVec3) -> Option<Box<dyn Field>> {
    Some(match name {
        "shells" => Box::new(Shells::new(extent)),
        "marschner-lobb" => Box::new(MarschnerLobb::new(extent)),
        "sparse-vessels" => Box::new(SparseVessels::new(extent)),
        _ => return None,
    })
}
