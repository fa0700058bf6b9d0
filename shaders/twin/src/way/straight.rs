//! A straight ray's path through the volume.

use super::walk::{Marched, Walk};
use crate::brick::{PairOfSteps, Straight, add_pair};
use crate::composite::{Accumulated, Composite};
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::refine::{Voxel, scalars_in_reach};
use crate::tables::is_vacant_around;
use crate::{Cast, Casting, Real, ray::Ray};
use layout::NO_NODE;

/// The length of the steps of a stretch, and how many pairs of them it is.
#[inline(always)]
pub(super) fn lay_out<F: Real, K: Kernel>(
    casting: &Casting<F>,
    way: Straight<F>,
    voxel: Voxel<F>,
    (from, to): (F, F),
) -> (F, u32) {
    let span = (to - from).most(F::ZERO);
    let longest = voxel.longest_step::<K>(casting, way.brick, way.ray, from);
    let pairs = (span / (F::of(2.0) * longest)).ceil().most(F::ONE);
    (F::of(0.5) * span / pairs, pairs.to_index())
}

/// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. If the steps of a pair turn out
/// too long for the tolerance, each of them is split into equal parts. If samples blend levels, the rest of the way is
/// divided anew after each pair, into pairs as long as the level there allows.
#[inline(always)]
pub(super) fn march<F: Real, K: Kernel>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    mut front: Accumulated<F>,
    way: Straight<F>,
    voxel: Voxel<F>,
    (t_in, t_out): (F, F),
) -> Marched<F> {
    let Straight { brick, ray } = way;
    let two = F::of(2.0);
    let mut from = t_in;
    let (mut step, mut count) = lay_out::<F, K>(casting, way, voxel, (t_in, t_out));
    let mut marched = Marched { front, samples: 0, is_done: false };
    let mut i = 0;
    let mut known = None;
    while i < count {
        let t0 = from + two * F::of_u32(i) * step;
        // Steps too short for t to grow by them are counted instead, or there would be no end.
        if brick.has_fractions::<K>() && t0 > from {
            from = t0;
            (step, count) = lay_out::<F, K>(casting, way, voxel, (from, t_out));
            i = 0;
        }
        let unseen = brick.pairs_unseen(t0, step);
        if unseen > 0 {
            i += unseen;
            known = None;
            continue;
        }
        i += 1;
        let s0 = known.unwrap_or_else(|| {
            marched.samples += 1;
            brick.scalar_at::<K>(casting, ray, t0)
        });
        let s1 = brick.scalar_at::<K>(casting, ray, t0 + step);
        let s2 = brick.scalar_at::<K>(casting, ray, t0 + two * step);
        marched.samples += 2;
        known = Some(s2);
        let range = scalars_in_reach(s0, s1, s2);
        let spreads = [0.5, 1.5].map(|steps| brick.spread_at::<K>(casting, ray, t0 + F::of(steps) * step));
        if is_vacant_around(&casting.tables.cells, range, spreads[0].most(spreads[1])) {
            continue;
        }
        let steps = PairOfSteps {
            first: way,
            second: way,
            t: [t0, t0 + step],
            length: step,
            scalars: [s0, s1, s2],
            range,
            spreads,
        };
        let (added, between) = add_pair::<F, K, _>(casting, chain, front, &steps);
        front = added;
        marched.samples += between;
        if K::Composite::still_to_come(casting, front) < casting.scene.termination {
            marched.is_done = true;
            break;
        }
    }
    marched.front = front;
    marched
}

#[inline(always)]
pub(super) fn cast_ray<F: Real, K: Kernel>(casting: &Casting<F>, ray: &Ray<F>) -> Cast<F> {
    let mut walk = Walk::begin(casting, ray);
    if walk.at == NO_NODE {
        return walk.end();
    }
    let chain = Chain::start::<K>(casting, ray);
    while walk.at != NO_NODE {
        let node = &casting.volume.nodes[walk.at as usize];
        let exit = walk.exit(casting, node);
        if walk.looks(casting, node, &exit) {
            let brick = Brick::new::<K>(casting, node, ray);
            let voxel = Voxel::new(casting, node, ray);
            let mut t = walk.t;
            // Cut where the law of an enhancer is not smooth.
            while t < exit.t && !walk.is_done {
                let until = chain.next_break::<K, F>(casting, t).least(exit.t);
                let way = Straight { brick: &brick, ray };
                let stretch = (t, until);
                let acts = || chain.acts::<K, F>(casting, &ray.line(), F::of(0.5) * (t + until)) > F::ZERO;
                walk.add(if K::IS_FULL || acts() {
                    march::<F, K>(casting, &chain, walk.front, way, voxel, stretch)
                } else {
                    march::<F, K::Plain>(casting, &chain, walk.front, way, voxel, stretch)
                });
                t = until;
            }
        }
        walk.go_on(casting, node, &exit);
    }
    walk.end()
}
