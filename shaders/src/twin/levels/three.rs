//! Samples of the node that a ray is in, of its parent and of its grandparent. Kernels of one level are told by this
//! twin, too: it then looks at no ancestor.

use super::Level;
use crate::compose::Levels;
use crate::layout::{CELL_WORDS, NO_NODE, NO_SLOT, NodeRecord};
use crate::twin::kernel::Kernel;
use crate::twin::traverse::voxel_edge;
use crate::twin::{Real, Scene, ray::Ray, vector::Vec3};

/// What stays the same on a straight way through one brick. Where an ancestor has no brick, the level below stands for it.
#[derive(Clone, Copy)]
pub struct Brick<'a, F> {
    /// The node.
    pub own: Level<'a, F>,
    /// Its parent.
    pub parent: Level<'a, F>,
    /// Its grandparent.
    pub grandparent: Level<'a, F>,
    /// The visible cells of the node's brick.
    pub cells: &'a [u32; CELL_WORDS],
    /// Metres per texel along each axis, without sign.
    pub pace: Vec3<F>,
    above_finest: F,
    coarsest: F,
    filters_levels: bool,
}

impl<'a, F: Real> Brick<'a, F> {
    /// The brick of a node, on a straight way.
    #[inline(always)]
    pub fn new<K: Kernel>(scene: &Scene<'a, F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let finest = scene.view.finest_depth;
        let edge = voxel_edge::<F>(finest, node.depth);
        let own = Level::new(scene, node, ray);
        let mut brick = Self {
            own,
            parent: own,
            grandparent: own,
            cells: scene.cells(node.slot),
            pace: ray.inverse.map(|c| c.abs() * edge),
            above_finest: F::of_u32(finest - node.depth),
            coarsest: F::ZERO,
            filters_levels: K::IS_FULL && scene.needs.levels == Levels::Quadrilinear,
        };
        if K::IS_FULL && scene.needs.reads_ancestors() {
            brick.add_ancestors(scene, node, ray);
        }
        brick
    }

    #[inline(never)]
    fn add_ancestors(&mut self, scene: &Scene<'a, F>, node: &NodeRecord, ray: &Ray<F>) {
        let above = |node: &NodeRecord| {
            let parent = scene.nodes.get(node.parent as usize).filter(|_| node.parent != NO_NODE)?;
            (parent.slot != NO_SLOT).then_some(parent)
        };
        let Some(parent) = above(node) else { return };
        self.parent = Level::new(scene, parent, ray);
        (self.grandparent, self.coarsest) = (self.parent, F::ONE);
        let Some(grandparent) = above(parent) else { return };
        self.grandparent = Level::new(scene, grandparent, ray);
        self.coarsest = F::of(2.0);
    }

    /// The fractional level that samples at t are filtered at: 0 is the node, 1 the parent, 2 the grandparent.
    #[inline(always)]
    pub fn fraction(&self, scene: &Scene<F>, ray: &Ray<F>, t: F) -> F {
        if !self.filters_levels {
            return F::ZERO;
        }
        let z = ray.origin_in_display.0[2] + ray.direction_in_display.0[2] * t;
        let [c0, c1] = scene.view.resolution;
        let wanted = (c0 + c1 * z.abs()).most(F::of(1e-30)).log2() - self.above_finest;
        wanted.most(F::ZERO).least(self.coarsest)
    }

    /// The scalar at t.
    #[inline(always)]
    pub fn scalar_at<K: Kernel>(&self, scene: &Scene<F>, ray: &Ray<F>, t: F) -> F {
        let s = if K::IS_FULL && self.filters_levels {
            self.scalar_over_levels(scene, ray, t)
        } else {
            self.own.scalar(t)
        };
        s.most(F::ZERO).least(F::ONE)
    }

    /// Not inlined: it is called from many places.
    #[inline(never)]
    fn scalar_over_levels(&self, scene: &Scene<F>, ray: &Ray<F>, t: F) -> F {
        let f = self.fraction(scene, ray, t);
        if f <= F::ZERO {
            return self.own.scalar(t);
        }
        let (near, far, share) = if f <= F::ONE {
            (&self.own, &self.parent, f)
        } else {
            (&self.parent, &self.grandparent, f - F::ONE)
        };
        let near = near.scalar(t);
        near + (far.scalar(t) - near) * share
    }
}
