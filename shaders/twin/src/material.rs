//! The material of a scalar: the light's own, or that of a table. Each is ambient, diffuse, specular, shininess.

use super::features::Features;
use super::four::each;
use super::tables::{locate_material, materials_between};
use super::{Casting, Real};

#[inline(always)]
fn has_one<F: Real, K: Features>(casting: &Casting<F>) -> bool {
    !K::IS_FULL || !casting.needs.has_materials
}

/// Mean between two scalars.
#[inline(always)]
pub fn material_between<F: Real, K: Features>(casting: &Casting<F>, s0: F, s1: F) -> [F; 4] {
    if has_one::<F, K>(casting) {
        return casting.scene.material;
    }
    let [a, b] = [s0, s1].map(|s| locate_material(casting.tables, s));
    materials_between(casting.tables, &a, &b)
}

/// Mean over both steps of a pair.
#[inline(always)]
pub fn material_of_pair<F: Real, K: Features>(casting: &Casting<F>, scalars: [F; 3]) -> [F; 4] {
    if has_one::<F, K>(casting) {
        return casting.scene.material;
    }
    let [a, b, c] = scalars.map(|s| locate_material(casting.tables, s));
    let [before, after] = [(&a, &b), (&b, &c)].map(|(a, b)| materials_between(casting.tables, a, b));
    each!(C => F::of(0.5) * (before[C] + after[C]))
}
