//! The material of a scalar: the light's own, or that of a table.

use super::tables::materials_between;
use super::{Casting, Real, features::Features};

/// Mean ambient, diffuse, specular, shininess between two scalars.
#[inline(always)]
pub fn material_between<F: Real, K: Features>(casting: &Casting<F>, s0: F, s1: F) -> [F; 4] {
    if !K::IS_FULL || !casting.needs.has_materials {
        return casting.scene.material;
    }
    materials_between(casting.tables, s0, s1)
}
