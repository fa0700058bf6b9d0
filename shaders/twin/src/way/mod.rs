//! How a ray passes through the volume.

mod beside;
mod enhancing;
mod in_level;
mod packet;
mod pair;
mod pairs;
mod path;
mod paths;
mod refracted;
mod segments;
mod straight;
mod walk;

pub(crate) use packet::cast_packet;
pub(crate) use segments::RAYS;

use super::composite::Accumulated;
use super::{Cast, Casting, Real, kernel::Kernel, ray::Ray};
use needs::Way;

/// A ray from the eye to its colour.
#[inline(always)]
pub(super) fn cast_ray<F: Real, K: Kernel>(casting: &Casting<F>, ray: &Ray<F>) -> Cast<F> {
    if K::IS_FULL && casting.needs.way == Way::Refracted {
        return refracted::cast_ray::<F, K>(casting, ray);
    }
    straight::cast_ray::<F, K>(casting, ray)
}

impl<F: Real> Cast<F> {
    /// A ray that meets nothing.
    const NOTHING: Self = Self { rgba: [F::ZERO; 4], samples: 0, is_missing: false };

    /// The colours gathered at the ray's end.
    #[inline(always)]
    fn with_colours(self, front: Accumulated<F>) -> Self {
        let [r, g, b] = front.rgb.0;
        Self { rgba: [r, g, b, front.alpha], ..self }
    }
}
