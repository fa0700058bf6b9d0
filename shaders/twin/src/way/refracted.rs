//! A bent ray's way through the volume: node by node, in straight pairs of steps with a turn in the middle of each.

use super::path::Bent;
use crate::composite::Accumulated;
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::ray::{Ray, far};
use crate::refine::Voxel;
use crate::traverse::{Exit, OWN_EDGE, node_low, voxel_edge};
use crate::{Cast, Casting, Real, vector::Vec3};
use layout::{NO_NODE, NO_SLOT, NodeRecord};

/// See `wgsl/way/refracted.wgsl` for these three.
const MOST_STEP: f64 = 0.25;
const LONGEST_WAY_DIAGONALS: f64 = 4.0;
const LEAST_PAIR: f64 = 1e-3;

/// Where the ray, which is inside, leaves the volume.
#[inline(always)]
fn exit_of_volume<F: Real>(casting: &Casting<F>, ray: &Ray<F>) -> F {
    let mut t = far::<F>();
    for axis in 0..3 {
        if !ray.is_parallel(axis) {
            let face = if ray.is_forward(axis) { casting.scene.dims.0[axis] } else { F::ZERO };
            t = t.least((face - ray.origin_in_volume.0[axis]) * ray.inverse.0[axis]);
        }
    }
    t
}

#[inline(always)]
fn is_in_box<F: Real>(point: Vec3<F>, low: Vec3<F>, high: Vec3<F>) -> bool {
    (0..3).all(|axis| point.0[axis] >= low.0[axis] && point.0[axis] <= high.0[axis])
}

#[inline(always)]
fn is_in_node<F: Real>(casting: &Casting<F>, node: &NodeRecord, point: Vec3<F>) -> bool {
    let finest = casting.scene.finest_depth;
    let low = node_low::<F>(finest, node);
    let edge = F::of(OWN_EDGE) * voxel_edge::<F>(finest, node.depth);
    is_in_box(point, low, low + Vec3::splat(edge))
}

/// How a straight way leaves a node.
struct Leaving<F> {
    exit: Exit<F>,
    /// Where it leaves the node, or the volume before that.
    t_out: F,
}

impl<F: Real> Leaving<F> {
    #[inline(always)]
    fn new(casting: &Casting<F>, node: &NodeRecord, ray: &Ray<F>) -> Self {
        let exit = casting.exit_of(node, ray);
        Self { exit, t_out: exit.t.least(exit_of_volume(casting, ray)) }
    }
}

/// A bent ray on its way.
pub(super) struct Walk<F> {
    pub(super) bent: Bent<F>,
    pub(super) chain: Chain<F>,
    pub(super) front: Accumulated<F>,
    pub(super) cast: Cast<F>,
    /// The scalar where it is, where that is known.
    pub(super) known: Option<F>,
    /// The node it is in, and the one that was last noted.
    at: u32,
    noted: u32,
}

#[inline(never)]
pub(super) fn cast_ray<F: Real, K: Kernel>(casting: &Casting<F>, eye_ray: &Ray<F>) -> Cast<F> {
    let (t_in, t_out) = eye_ray.clip_to_volume(casting.scene.dims);
    if !matches!(t_in.partial_cmp(&t_out), Some(std::cmp::Ordering::Less)) {
        return Cast::NOTHING;
    }
    let mut walk = Walk::start::<K>(casting, eye_ray, t_in);
    let longest_way = casting.scene.diagonal_m * F::of(LONGEST_WAY_DIAGONALS);
    while walk.at != NO_NODE && walk.bent.way < longest_way {
        if !walk.go_on::<K>(casting) {
            break;
        }
    }
    walk.cast.with_colours(walk.front)
}

impl<F: Real> Walk<F> {
    #[inline(always)]
    fn start<K: Kernel>(casting: &Casting<F>, eye_ray: &Ray<F>, t: F) -> Self {
        let mut chain = Chain::start::<K>(casting, eye_ray);
        let bent = Bent::entering(casting, eye_ray, t);
        chain.follow(casting, &bent.ray);
        let at = casting.leaf_at(bent.ray.origin_in_volume, &bent.ray);
        let front = Accumulated::NOTHING;
        Self { bent, chain, front, cast: Cast::NOTHING, known: None, at, noted: NO_NODE }
    }

    /// Takes one pair of steps, or passes over what shows nothing; whether the way goes on.
    #[inline(always)]
    fn go_on<K: Kernel>(&mut self, casting: &Casting<F>) -> bool {
        let node = &casting.volume.nodes[self.at as usize];
        if self.bent.renew(casting) {
            self.chain.follow(casting, &self.bent.ray);
        }
        let leaving = Leaving::new(casting, node, &self.bent.ray);
        if node.slot == NO_SLOT {
            self.known = None;
            self.bent.way = self.bent.way + (leaving.t_out - self.bent.t).most(F::ZERO);
            self.bent.t = leaving.t_out.most(self.bent.t);
            self.bent.forget();
            return self.leave(casting, node, &leaving);
        }
        self.note(casting, node);
        let brick = Brick::new::<K>(casting, node, &self.bent.ray);
        let (step, pairs) = self.lay_out::<K>(casting, node, &brick, leaving.t_out);
        let unseen = brick.pairs_unseen(self.bent.t, step);
        if unseen > 0 {
            self.known = None;
            self.bent.advance(F::of_u32(unseen).least(pairs) * F::of(2.0) * step);
            return self.bent.t < leaving.t_out || self.leave(casting, node, &leaving);
        }
        let taken = self.take_pair::<K>(casting, node, &brick, step);
        if taken.is_last {
            return false;
        }
        if taken.is_turned {
            return self.find_node(casting, node);
        }
        self.bent.t < leaving.t_out || self.leave(casting, node, &leaving)
    }

    /// Notes a node that the ray comes into.
    #[inline(always)]
    fn note(&mut self, casting: &Casting<F>, node: &NodeRecord) {
        if self.noted != self.at {
            self.noted = self.at;
            self.known = None;
            casting.observer.note(self.at, node.deficit);
            self.cast.is_missing |= node.deficit > 0.0;
        }
    }

    /// As many equal pairs as lie between here and the border or the next break, of which one is taken: the length of their
    /// steps, and how many they are.
    #[inline(always)]
    fn lay_out<K: Kernel>(
        &self,
        casting: &Casting<F>,
        node: &NodeRecord,
        brick: &Brick<F>,
        t_out: F,
    ) -> (F, F) {
        let Bent { ray, t, .. } = &self.bent;
        let voxel = Voxel::new(casting, node, ray);
        let until = t_out.least(self.chain.next_break::<K, F>(casting, *t));
        let span = (until - *t).most(F::of(LEAST_PAIR) * voxel.edge);
        let longest = voxel.longest_step::<K>(casting, brick, ray, *t);
        let longest = longest.least(F::of(MOST_STEP) * voxel.edge);
        let pairs = (span / (F::of(2.0) * longest)).ceil().most(F::ONE);
        (F::of(0.5) * span / pairs, pairs)
    }

    /// Goes over a node's border; whether it goes on beyond.
    #[inline(always)]
    fn leave(&mut self, casting: &Casting<F>, node: &NodeRecord, leaving: &Leaving<F>) -> bool {
        if leaving.t_out < leaving.exit.t {
            return false;
        }
        let point = self.bent.ray.point(self.bent.t);
        self.at = casting.leaf_beyond(node, leaving.exit.axis, point, &self.bent.ray);
        true
    }

    /// Finds out which node a turn led into; whether it is inside the volume.
    #[inline(always)]
    fn find_node(&mut self, casting: &Casting<F>, node: &NodeRecord) -> bool {
        let point = self.bent.ray.point(self.bent.t);
        if !is_in_box(point, Vec3::ZERO, casting.scene.dims) {
            return false;
        }
        if !is_in_node(casting, node, point) {
            self.at = casting.leaf_at(point, &self.bent.ray);
        }
        true
    }
}
