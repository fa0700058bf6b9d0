//! A node's share of its own samples, by the weights of its corners; the parent has the rest.

use super::Level;
use crate::four::{between_corners, each, mix};
use crate::{Real, traverse::OWN_EDGE};
use layout::{FULL_WEIGHTS, NodeRecord};

/// See `Weights` in `wgsl/levels/weights.wgsl`.
#[derive(Clone, Copy)]
pub struct Weights<F> {
    /// Of the corners with low z and with high z.
    low: [F; 4],
    high: [F; 4],
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
        let unit = |c: F| ((c - F::of(Level::<F>::OVERLAP)) / F::of(OWN_EDGE)).most(F::ZERO).least(F::ONE);
        let [x, y, z] = own.point(t).map(unit).0;
        F::ONE - between_corners(mix(self.low, self.high, z), x, y)
    }
}
