//! The gradients at the level that a sample is filtered at, and one and two levels above it.

use super::central::gradient_in;
use crate::features::Features;
use crate::levels::Brick;
use crate::{Casting, Real, ray::Ray, vector::Vec3};

/// Of the scalar per finest voxel's edge, display frame.
#[derive(Clone, Copy, Debug)]
pub struct Gradients<F> {
    /// At the level that the sample itself is filtered at.
    pub at: Vec3<F>,
    /// One level above; set only if the shading reads it.
    pub coarse: Vec3<F>,
    /// Two levels above; set only if the shading reads it.
    pub coarsest: Vec3<F>,
}

impl<F: Real> Gradients<F> {
    /// Where none is needed.
    pub const NONE: Self = Self { at: Vec3::ZERO, coarse: Vec3::ZERO, coarsest: Vec3::ZERO };

    /// At t.
    #[inline(always)]
    pub fn new<K: Features>(casting: &Casting<F>, brick: &Brick<F>, ray: &Ray<F>, t: F) -> Self {
        if (K::IS_FULL && casting.needs.reads_grandparents()) || brick.is_blended::<K>() {
            return Self::over_levels(casting, brick, ray, t);
        }
        Self { at: gradient_in(casting, &brick.own, t), ..Self::NONE }
    }

    /// Half-way to another.
    #[inline(always)]
    pub fn halfway(&self, other: &Self) -> Self {
        let between = |a: Vec3<F>, b: Vec3<F>| (a + b) * F::of(0.5);
        Self {
            at: between(self.at, other.at),
            coarse: between(self.coarse, other.coarse),
            coarsest: between(self.coarsest, other.coarsest),
        }
    }

    /// Not inlined: it is called from many places.
    #[inline(never)]
    fn over_levels(casting: &Casting<F>, brick: &Brick<F>, ray: &Ray<F>, t: F) -> Self {
        let f = brick.fraction(casting, ray, t);
        if casting.needs.shading.has_detail() {
            return Self::detailed(casting, brick, f, t);
        }
        let (near, far, share) = if f < F::ONE {
            (&brick.own, &brick.parent, f)
        } else {
            (&brick.parent, &brick.grandparent, f - F::ONE)
        };
        let near = gradient_in(casting, near, t);
        let at = if share <= F::ZERO { near } else { near.lerp(gradient_in(casting, far, t), share) };
        Self { at, ..Self::NONE }
    }

    fn detailed(casting: &Casting<F>, brick: &Brick<F>, f: F, t: F) -> Self {
        let own = gradient_in(casting, &brick.own, t);
        let parent = gradient_in(casting, &brick.parent, t);
        let grandparent = gradient_in(casting, &brick.grandparent, t);
        let between = |f: F| {
            let share = |f: F| f.most(F::ZERO).least(F::ONE);
            own.lerp(parent, share(f)).lerp(grandparent, share(f - F::ONE))
        };
        Self { at: between(f), coarse: between(f + F::ONE), coarsest: grandparent }
    }
}
