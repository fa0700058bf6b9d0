//! Samples of the node that a ray is in, of its parent and of its grandparent. This is also the twin of kernels with
//! one level and with two: it then reads no ancestor, or only the parent.

use super::{Level, weights::Weights};
use crate::features::Features;
use crate::traverse::voxel_edge;
use crate::{Casting, Real, ray::Ray, vector::Vec3};
use layout::{CELL_WORDS, NO_NODE, NO_SLOT, NodeRecord};
use needs::Levels;

/// What stays the same on a straight path through one brick. Where an ancestor has no brick, the level below stands for it.
#[derive(Clone, Copy)]
pub struct Brick<'a, F> {
    /// The node.
    pub own: Level<'a, F>,
    /// Its parent.
    pub parent: Level<'a, F>,
    /// Its grandparent.
    pub grandparent: Level<'a, F>,
    /// The node's share, and its parent's.
    pub(crate) weights: Weights<F>,
    /// The visible cells of the node's brick.
    pub cells: &'a [u32; CELL_WORDS],
    /// Metres per texel along each axis, without sign.
    pub pace: Vec3<F>,
    above_finest: F,
    coarsest: F,
    filters_levels: bool,
}

impl<'a, F: Real> Brick<'a, F> {
    /// The brick of a node, on a straight path.
    #[inline(always)]
    pub fn new<K: Features>(casting: &Casting<'a, F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let finest = casting.scene.finest_depth;
        let edge = voxel_edge::<F>(finest, node.depth);
        let own = Level::new(casting, node, ray);
        let mut brick = Self {
            own,
            parent: own,
            grandparent: own,
            weights: Weights::FULL,
            cells: casting.volume.cells(node.slot),
            pace: ray.inverse.map(|c| c.abs() * edge),
            above_finest: F::of_u32(finest - node.depth),
            coarsest: F::ZERO,
            filters_levels: K::IS_FULL && casting.needs.levels == Levels::Quadrilinear,
        };
        if K::BLENDS && casting.needs.blends {
            brick.weights = Weights::new(node);
        }
        if K::BLENDS && (brick.weights.is_blended || (K::IS_FULL && casting.needs.reads_grandparents())) {
            brick.add_ancestors(casting, node, ray);
        }
        brick
    }

    /// Whether the parent has a share of the samples by the weights of the node's corners.
    #[inline(always)]
    pub fn is_blended<K: Features>(&self) -> bool {
        K::BLENDS && self.weights.is_blended
    }

    /// Whether scalars are not of the node's own level alone.
    #[inline(always)]
    pub fn has_levels<K: Features>(&self) -> bool {
        (K::IS_FULL && self.filters_levels) || self.is_blended::<K>()
    }

    /// Whether samples may be of levels above the node's.
    #[inline(always)]
    pub fn has_fractions<K: Features>(&self) -> bool {
        self.is_blended::<K>() || (K::IS_FULL && self.filters_levels && self.coarsest > F::ZERO)
    }

    /// The parent's share at t, of a blended node.
    #[inline(always)]
    pub fn parents_share(&self, t: F) -> F {
        self.weights.parents_share(&self.own, t)
    }

    #[inline(never)]
    fn add_ancestors(&mut self, casting: &Casting<'a, F>, node: &NodeRecord, ray: &Ray<F>) {
        let above = |node: &NodeRecord| {
            let parent = casting.volume.nodes.get(node.parent as usize).filter(|_| node.parent != NO_NODE)?;
            (parent.slot != NO_SLOT).then_some(parent)
        };
        let Some(parent) = above(node) else {
            self.weights = Weights::FULL;
            return;
        };
        self.parent = Level::new(casting, parent, ray);
        (self.grandparent, self.coarsest) = (self.parent, F::ONE);
        let Some(grandparent) = above(parent) else { return };
        self.grandparent = Level::new(casting, grandparent, ray);
        self.coarsest = F::of(2.0);
    }

    /// The fractional level of samples at t, 0 is the node, 1 the parent, 2 the grandparent: the one that they are
    /// filtered at, or the parent's share by the node's corners where that is more.
    #[inline(always)]
    pub fn fraction(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> F {
        let filtered = if self.filters_levels { self.filtered_fraction(casting, ray, t) } else { F::ZERO };
        if self.weights.is_blended { filtered.most(self.parents_share(t)) } else { filtered }
    }

    #[inline(always)]
    fn filtered_fraction(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> F {
        let z = ray.origin_in_display.0[2] + ray.direction_in_display.0[2] * t;
        let [c0, c1] = casting.scene.resolution;
        let wanted = (c0 + c1 * z.abs()).most(F::of(1e-30)).log2() - self.above_finest;
        wanted.most(F::ZERO).least(self.coarsest)
    }

    /// The scalar at t.
    #[inline(always)]
    pub fn scalar_at<K: Features>(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> F {
        let s = if K::IS_FULL && (self.filters_levels || self.weights.is_blended) {
            self.scalar_over_levels(casting, ray, t)
        } else if self.is_blended::<K>() {
            self.scalar_toward_parent(t)
        } else {
            self.own.scalar(t)
        };
        s.most(F::ZERO).least(F::ONE)
    }

    /// Not inlined: it is called from many places.
    #[inline(never)]
    fn scalar_over_levels(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> F {
        let f = self.fraction(casting, ray, t);
        if f <= F::ONE {
            return self.scalar_between(f, t);
        }
        let near = self.parent.scalar(t);
        near + (self.grandparent.scalar(t) - near) * (f - F::ONE)
    }

    /// The same where no level above the parent has a share.
    #[inline(never)]
    fn scalar_toward_parent(&self, t: F) -> F {
        self.scalar_between(self.parents_share(t), t)
    }

    /// From the node (0) to its parent (1), which alone is looked at there.
    #[inline(always)]
    fn scalar_between(&self, f: F, t: F) -> F {
        if f >= F::ONE {
            return self.parent.scalar(t);
        }
        let own = self.own.scalar(t);
        if f <= F::ZERO { own } else { own + (self.parent.scalar(t) - own) * f }
    }
}
