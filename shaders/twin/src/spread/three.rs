//! The spread of the node that a ray is in, of its parent and of its grandparent, blended as their samples are.

use crate::features::Features;
use crate::levels::Brick;
use crate::{Casting, Real, ray::Ray};

impl<F: Real> Brick<'_, F> {
    /// Half-width at t of the scalars that samples stand for; see `wgsl/spread/three.wgsl`.
    #[inline(always)]
    pub fn spread_at<K: Features>(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> F {
        if !(K::BLENDS && casting.needs.spreads) {
            return F::ZERO;
        }
        let f = if self.has_fractions::<K>() { self.fraction(casting, ray, t) } else { F::ZERO };
        if f <= F::ZERO {
            return self.own.spread(t);
        }
        let parent = self.parent.spread(t);
        if f < F::ONE {
            let own = self.own.spread(t);
            return own + (parent - own) * f;
        }
        if f <= F::ONE { parent } else { parent + (self.grandparent.spread(t) - parent) * (f - F::ONE) }
    }
}
