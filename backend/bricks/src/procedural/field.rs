//! A scalar field given by a formula.

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
