//! Eight straight paths through one brick, side by side. Each is computed as [`Brick`] computes it alone, in the same
//! order, so that a ray sees the same to the bit whoever goes beside it.

use super::in_level::{LaidInLevel, PathsInLevel};
use super::segments::{RAYS, first_of};
use crate::Casting;
use crate::along::Along;
use crate::brick::{ACROSS, CELL, Straight, points_asked};
use crate::kernel::Kernel;
use crate::levels::{Brick, parents_share};
use crate::real::Number;
use crate::refine::{Voxel, step_voxels};
use crate::shade::Shade;
use crate::vector::Vec3;
use lanes::*;
use layout::CELL_WORDS;

/// Where paths lie in a brick, one after another. One that is nowhere has no length.
#[derive(Default)]
pub(super) struct Laid {
    own: LaidInLevel,
    parent: LaidInLevel,
    pace: [[f32; RAYS]; 3],
    voxel: [f32; RAYS],
    from: [f32; RAYS],
    until: [f32; RAYS],
    most_extinction: f32,
    /// The rays that are in the brick.
    pub(super) rays: u64,
}

impl Laid {
    /// Lays a path from t to t.
    #[inline(always)]
    pub(super) fn lay(
        &mut self,
        lane: usize,
        brick: &Brick<f32>,
        voxel: &Voxel<f32>,
        (from, until): (f32, f32),
    ) {
        self.own.lay(lane, &brick.own);
        self.parent.lay(lane, &brick.parent);
        for axis in 0..3 {
            self.pace[axis][lane] = brick.pace.0[axis];
        }
        self.voxel[lane] = voxel.edge;
        self.most_extinction = voxel.most_extinction;
        (self.from[lane], self.until[lane]) = (from, until);
        self.rays |= 1 << lane;
    }
}

/// So few rays look things up each alone: eight side by side take longer.
const FEW: u32 = 2;

/// Paths through a brick.
pub(super) struct Paths<'a, S: Simd> {
    simd: S,
    /// Each alone, where it is in the brick.
    pub(super) ways: &'a [Option<Straight<'a, f32>>; RAYS],
    cells: &'a [u32; CELL_WORDS],
    own: PathsInLevel<'a, S>,
    parent: PathsInLevel<'a, S>,
    /// The weights of the node's corners, where its parent has a share.
    weights: Option<[[f32; 4]; 2]>,
    pace: [f32x8<S>; 3],
    voxel: f32x8<S>,
    most_extinction: f32,
    /// Where steps are counted from.
    from: f32x8<S>,
    until: f32x8<S>,
    /// Metres of a step.
    pub(super) step: f32x8<S>,
    /// Points of a pair that are asked what they see.
    asked: f32x8<S>,
    /// Metres from one to the next.
    apart: f32x8<S>,
    most_asked: f32,
}

impl<'a, S: Simd> Paths<'a, S> {
    /// Paths through a brick, which is that of `any` of them; they have no steps yet.
    #[inline(always)]
    pub(super) fn new<K: Kernel>(
        simd: S,
        ways: &'a [Option<Straight<'a, f32>>; RAYS],
        any: &Straight<'a, f32>,
        laid: &Laid,
    ) -> Self {
        let (brick, zero) = (any.brick, splat(simd, 0.0));
        Self {
            simd,
            ways,
            cells: brick.cells,
            own: PathsInLevel::new(simd, &brick.own, &laid.own),
            parent: PathsInLevel::new(simd, &brick.parent, &laid.parent),
            weights: brick.has_fractions::<K>().then_some([brick.weights.low, brick.weights.high]),
            pace: each!(axis of 3 => load(simd, &laid.pace[axis], 0)),
            voxel: load(simd, &laid.voxel, 0),
            most_extinction: laid.most_extinction,
            from: load(simd, &laid.from, 0),
            until: load(simd, &laid.until, 0),
            step: zero,
            asked: zero,
            apart: zero,
            most_asked: 0.0,
        }
    }

    #[inline(always)]
    fn number(&self, value: f32) -> f32x8<S> {
        splat(self.simd, value)
    }

    /// Whether steps are laid out anew after each pair.
    #[inline(always)]
    pub(super) fn has_fractions(&self) -> bool {
        self.weights.is_some()
    }

    /// Where the pair of each that is `at` so many begins.
    #[inline(always)]
    pub(super) fn t(&self, at: i32x8<S>) -> f32x8<S> {
        let at: f32x8<S> = at.to_float();
        self.from + self.number(2.0) * at * self.step
    }

    /// Which of them are beyond where their steps are counted from.
    #[inline(always)]
    pub(super) fn beyond(&self, t: f32x8<S>) -> mask32x8<S> {
        t.simd_gt(self.from)
    }

    /// Lays out what is left of the paths of some rays from where they are, `t`, and returns how many pairs that is: see
    /// [`super::straight::lay_out`].
    #[inline(always)]
    pub(super) fn lay_out<K: Kernel>(
        &mut self,
        casting: &Casting<f32>,
        t: f32x8<S>,
        rays: mask32x8<S>,
    ) -> i32x8<S> {
        let scene = casting.scene;
        let mut edge = self.voxel;
        if let Some(share) = self.parents_share(t) {
            edge *= self.number(0.0).most(share).exp2();
        }
        let depth = self.number(self.most_extinction) * edge;
        let safe = self.number(K::Shade::safe_depth(casting.needs) as f32);
        let (shortest, tolerance) = (self.number(scene.step_voxels), self.number(scene.tolerance));
        let longest = step_voxels(shortest, depth, safe, tolerance) * edge;
        let span = (self.until - t).most(self.number(0.0));
        let pairs = Number::ceil(span / (self.number(2.0) * longest)).most(self.number(1.0));
        self.from = rays.select(t, self.from);
        self.step = rays.select(self.number(0.5) * span / pairs, self.step);
        self.asked = points_asked(self.own.slope, self.step);
        self.apart = self.number(2.0) * self.step / self.asked;
        self.most_asked = largest(self.asked);
        pairs.to_int()
    }

    /// Where all paths begin.
    #[inline(always)]
    pub(super) fn begin(&self) -> f32x8<S> {
        self.from
    }

    /// The parent's share at `t`; None where it has none anywhere.
    #[inline(always)]
    fn parents_share(&self, t: f32x8<S>) -> Option<f32x8<S>> {
        let [low, high] = self.weights?;
        let low = each!(corner of 4 => self.number(low[corner]));
        let high = each!(corner of 4 => self.number(high[corner]));
        Some(parents_share([low, high], self.own.point(t)))
    }

    /// The point of pairs at `t` that is asked as number `j`, and of which there is one.
    #[inline(always)]
    fn asked(&self, t: f32x8<S>, j: f32) -> ([f32x8<S>; 3], mask32x8<S>) {
        (self.own.point(t + self.apart * self.number(j + 0.5)), self.number(j).simd_lt(self.asked))
    }

    /// Which pairs at `t` may show something.
    #[inline(always)]
    pub(super) fn see(&self, t: f32x8<S>) -> mask32x8<S> {
        let (point, _) = self.asked(t, 0.0);
        let mut see = self.are_visible(point);
        let mut j = 1.0;
        while j < self.most_asked {
            let (point, are_asked) = self.asked(t, j);
            see |= self.are_visible(point) & are_asked;
            j += 1.0;
        }
        see
    }

    /// Pairs from `t` on that show nothing, where the first do not.
    #[inline(always)]
    pub(super) fn pairs_unseen(&self, t: f32x8<S>) -> i32x8<S> {
        let (point, _) = self.asked(t, 0.0);
        let mut unseen = self.pairs_across(point);
        let mut j = 1.0;
        while j < self.most_asked {
            let (point, are_asked) = self.asked(t, j);
            let across = self.pairs_across(point);
            unseen = (are_asked & across.simd_lt(unseen)).select(across, unseen);
            j += 1.0;
        }
        unseen
    }

    /// See [`Brick::is_visible_at`].
    #[inline(always)]
    fn are_visible(&self, point: [f32x8<S>; 3]) -> mask32x8<S> {
        let [x, y, z] = each!(axis of 3 => {
            let cell: i32x8<S> = (point[axis] * self.number(1.0 / CELL as f32)).to_int();
            cell & i32x8::splat(self.simd, ACROSS as i32 - 1)
        });
        let across = i32x8::splat(self.simd, ACROSS as i32);
        let cell = ((z * across + y) * across + x).to_array();
        let words = eight!(L => self.cells[(cell[L] >> 5) as usize % CELL_WORDS]);
        let bits = eight!(L => (words[L] >> (cell[L] & 31) & 1) as i32);
        i32x8::load_array(self.simd, bits).simd_gt(i32x8::splat(self.simd, 0))
    }

    /// See [`Brick::pairs_across`].
    #[inline(always)]
    fn pairs_across(&self, middle: [f32x8<S>; 3]) -> i32x8<S> {
        let (zero, edge) = (self.number(0.0), self.number(CELL as f32));
        let mut way = self.number(1e30);
        for (axis, middle) in middle.into_iter().enumerate() {
            let in_cells: i32x8<S> = (middle * self.number(1.0 / CELL as f32)).to_int();
            let low: f32x8<S> = in_cells.to_float();
            let low = low * edge;
            let face = self.own.slope[axis].simd_ge(zero).select(low + edge, low);
            way = way.least(Number::abs(face - middle) * self.pace[axis]);
        }
        let pairs = Number::ceil(way / (self.number(2.0) * self.step));
        pairs.most(self.number(1.0)).least(self.number(1e6)).to_int()
    }

    /// The scalars of some rays at `t`: see [`Brick::scalar_at`].
    #[inline(always)]
    pub(super) fn scalars<K: Kernel>(
        &self,
        casting: &Casting<f32>,
        t: f32x8<S>,
        rays: mask32x8<S>,
    ) -> f32x8<S> {
        let mut rays = rays.to_bitmask();
        if rays.count_ones() <= FEW {
            let mut scalars = [0.0; RAYS];
            while rays != 0 {
                let lane = first_of(&mut rays);
                if let Some(way) = &self.ways[lane] {
                    scalars[lane] = way.scalar_at::<K>(casting, t[lane]);
                }
            }
            return load(self.simd, &scalars, 0);
        }
        let mut scalars = self.own.scalars(t);
        if let Some(share) = self.parents_share(t) {
            scalars = self.blended(share, scalars, self.parent.scalars(t));
        }
        scalars.most(self.number(0.0)).least(self.number(1.0))
    }

    /// Half-widths of the scalars that samples at `t` stand for: see [`Brick::spread_at`].
    #[inline(always)]
    pub(super) fn spreads(&self, t: f32x8<S>) -> f32x8<S> {
        let own = self.own.spreads(t);
        match self.parents_share(t) {
            Some(share) => self.blended(share, own, self.parent.spreads(t)),
            None => own,
        }
    }

    /// The gradients of some rays at `t`, zero of all others: see [`crate::gradient::Gradients`].
    #[inline(always)]
    pub(super) fn gradients<K: Kernel>(
        &self,
        casting: &Casting<f32>,
        t: f32x8<S>,
        rays: mask32x8<S>,
    ) -> Vec3<f32x8<S>> {
        let (read, mut rays, zero) = (rays, rays.to_bitmask(), self.number(0.0));
        if rays.count_ones() <= FEW {
            let mut gradients = [[0.0; RAYS]; 3];
            while rays != 0 {
                let lane = first_of(&mut rays);
                if let Some(way) = &self.ways[lane] {
                    let gradient = way.gradients_at::<K>(casting, t[lane]).at;
                    for (list, along) in gradients.iter_mut().zip(gradient.0) {
                        list[lane] = along;
                    }
                }
            }
            return Vec3(each!(axis of 3 => load(self.simd, &gradients[axis], 0)));
        }
        let mut gradients = self.own.gradients(casting, t);
        if let Some(share) = self.parents_share(t) {
            let (own, parent) = (gradients, self.parent.gradients(casting, t));
            gradients = Vec3(each!(axis of 3 => self.blended(share, own.0[axis], parent.0[axis])));
        }
        Vec3(each!(axis of 3 => read.select(gradients.0[axis], zero)))
    }

    /// What is of the node itself and of its parent, which has a share.
    #[inline(always)]
    fn blended(&self, share: f32x8<S>, own: f32x8<S>, parent: f32x8<S>) -> f32x8<S> {
        let (zero, one) = (self.number(0.0), self.number(1.0));
        let between = own + (parent - own) * share;
        share.simd_ge(one).select(parent, share.simd_le(zero).select(own, between))
    }
}
