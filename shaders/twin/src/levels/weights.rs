//! A node's share of its own samples, by the weights of its corners; the parent has the rest.

use super::Level;
use crate::four::{between_corners, each, mix};
use crate::{Real, real::Number, traverse::OWN_EDGE};
use layout::{FULL_WEIGHTS, NodeRecord, brick};

/// See `Weights` in `wgsl/levels/weights.wgsl`.
#[derive(Clone, Copy)]
pub struct Weights<F> {
    /// Of the corners with low z and with high z.
    pub(crate) low: [F; 4],
    pub(crate) high: [F; 4],
    /// Whether the parent has any share.
    pub is_blended: bool,
}

impl<F: Real> Weights<F> {
    /// Of a node whose samples are all its own.
    pub const FULL: Self = Self { low: [F::ONE; 4], high: [F::ONE; 4], is_blended: false };

    /// Of a node whose parent has a brick.
    #[inline(always)]
    pub fn new(node: &NodeRecord) -> Self {
        if node.weights == FULL_WEIGHTS {
            return Self::FULL;
        }
        let [low, high] = node.weights.map(u32::to_le_bytes);
        let unit = F::of(255.0);
        Self {
            low: each!(C => F::of_u32(u32::from(low[C])) / unit),
            high: each!(C => F::of_u32(u32::from(high[C])) / unit),
            is_blended: true,
        }
    }

    /// The parent's share at t on the way that `own` lies on, of a blended node.
    #[inline(always)]
    pub fn parents_share(&self, own: &Level<F>, t: F) -> F {
        parents_share([self.low, self.high], own.point(t).0)
    }
}

/// The parent's share at a point, in texels, of a node with corners of such weights.
#[inline(always)]
pub(crate) fn parents_share<F: Number>([low, high]: [[F; 4]; 2], [x, y, z]: [F; 3]) -> F {
    let (zero, one) = (x.alike(0.0), x.alike(1.0));
    let (overlap, edge) = (x.alike(brick::OVERLAP as f64), x.alike(OWN_EDGE));
    let x = ((x - overlap) / edge).most(zero).least(one);
    let y = ((y - overlap) / edge).most(zero).least(one);
    let z = ((z - overlap) / edge).most(zero).least(one);
    one - between_corners(mix(low, high, z), x, y)
}
