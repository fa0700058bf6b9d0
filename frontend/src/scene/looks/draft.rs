//! A look before it knows the voxels that it is for.

use optics::Light;

/// Control points: a data value, extinction, and linear red, green, blue.
pub(super) type Points = Vec<(f64, f64, [f64; 3])>;

/// What extinctions are per.
#[derive(Clone, Copy, Debug)]
pub(super) enum Per {
    /// A metre of the patient.
    Metre,
    /// The volume's longest edge.
    Volume,
}

/// A look before it knows the voxels.
pub(super) struct Draft {
    pub points: Points,
    pub per: Per,
    /// None takes the whole range of the volume.
    pub domain: Option<(f64, f64)>,
    pub light: Option<Light>,
}
