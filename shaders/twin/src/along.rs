//! What lies along a straight way: in a brick, or between places where it is known.

use super::features::Features;
use super::gradient::Gradients;
use super::{Casting, Real, ray::Ray};

/// What lies along a straight way.
pub(super) trait Along<F: Real> {
    /// The way.
    fn ray(&self) -> &Ray<F>;
    /// The scalar at t.
    fn scalar_at<K: Features>(&self, casting: &Casting<F>, t: F) -> F;
    /// Half-width of the scalars that the sample at t stands for.
    fn spread_at<K: Features>(&self, casting: &Casting<F>, t: F) -> F;
    /// The gradients at t.
    fn gradients_at<K: Features>(&self, casting: &Casting<F>, t: F) -> Gradients<F>;
}
