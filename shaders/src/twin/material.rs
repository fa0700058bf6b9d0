//! The material of a scalar: the light's own, or that of a table.

use super::{Casting, Real, features::Features};

/// Ambient, diffuse, specular, shininess.
#[inline(always)]
pub fn material_at<F: Real, K: Features>(casting: &Casting<F>, s: F) -> [F; 4] {
    if !K::IS_FULL || !casting.needs.has_materials {
        return casting.scene.material;
    }
    let table = &casting.tables.materials;
    let u = s * F::of_u32(table.len() as u32 - 1);
    let cell = (u.to_index() as usize).min(table.len() - 2);
    let f = u - F::of_u32(cell as u32);
    std::array::from_fn(|c| {
        let (a, b) = (F::of_f32(table[cell][c]), F::of_f32(table[cell + 1][c]));
        a + (b - a) * f
    })
}
