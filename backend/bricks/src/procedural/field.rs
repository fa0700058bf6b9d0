//! A scalar field given by a formula.

use super::{MarschnerLobb, Shells, SparseVessels};
use glam::DVec3;

/// A scalar field over the unit cube; a volume of dims (nx, ny, nz) fills the part up to `extent` = dims / max(dims),
/// so its voxels are cubes of edge 1 / max(dims). Defined outside too, where coarse levels have samples.
pub trait Field: Send + Sync {
    /// The value at a position, in [0, 1].
    fn value(&self, position: DVec3) -> f64;
    /// The derivative of the value by position, per unit of the cube.
    fn gradient(&self, position: DVec3) -> DVec3;
    /// Bounds of the value over an axis-parallel box: never tighter than the truth, and (0, 0) only if it is 0 throughout.
    fn range_in_box(&self, low: DVec3, high: DVec3) -> (f64, f64);
}

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
