//! A straight ray's path through the volume.

use crate::brick::{PairOfSteps, Straight, add_pair};
use crate::composite::{Accumulated, Composite};
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::refine::{Voxel, scalars_in_reach};
use crate::tables::is_vacant_around;
use crate::{Cast, Casting, Real, ray::Ray};
use layout::{NO_NODE, NO_SLOT};

struct Marched<F> {
    front: Accumulated<F>,
    samples: u32,
    is_done: bool,
}

/// Follows the ray through one brick, from t_in to t_out, in equal pairs of steps. If the steps of a pair turn out
/// too long for the tolerance, each of them is split into equal parts. If samples blend levels, the rest of the way is
/// divided anew after each pair, into pairs as long as the level there allows.
#[inline(always)]
fn march<F: Real, K: Kernel>(
    casting: &Casting<F>,
    chain: &Chain<F>,
    mut front: Accumulated<F>,
    way: Straight<F>,
    voxel: Voxel<F>,
    (t_in, t_out): (F, F),
) -> Marched<F> {
    let Straight { brick, ray } = way;
    let two = F::of(2.0);
    let lay_out = |from: F| {
        let span = (t_out - from).most(F::ZERO);
        let longest = voxel.longest_step::<K>(casting, brick, ray, from);
        let pairs = (span / (two * longest)).ceil().most(F::ONE);
        (F::of(0.5) * span / pairs, pairs.to_index())
    };
    let mut from = t_in;
    let (mut step, mut count) = lay_out(t_in);
    let mut marched = Marched { front, samples: 0, is_done: false };
    let mut i = 0;
    let mut known = None;
    while i < count {
        let t0 = from + two * F::of_u32(i) * step;
        // Steps too short for t to grow by them are counted instead, or there would be no end.
        if brick.has_fractions::<K>() && t0 > from {
            from = t0;
            (step, count) = lay_out(from);
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
    let mut front = Accumulated::NOTHING;
    let mut cast = Cast::NOTHING;
    let (mut t, t_end) = ray.clip_to_volume(casting.scene.dims);
    // Not `t >= t_end`: a span that is not a number is empty, too.
    if !matches!(t.partial_cmp(&t_end), Some(std::cmp::Ordering::Less)) {
        return cast;
    }
    let chain = Chain::start::<K>(casting, ray);
    let mut at = casting.leaf_at(ray.point(t), ray);
    while at != NO_NODE {
        let node = &casting.volume.nodes[at as usize];
        let exit = casting.exit_of(node, ray);
        let t_out = exit.t.most(t).least(t_end);
        if node.slot != NO_SLOT && t_out > t {
            casting.observer.note(at, node.deficit);
            let brick = Brick::new::<K>(casting, node, ray);
            let voxel = Voxel::new(casting, node, ray);
            let mut is_done = false;
            // Cut where the law of an enhancer is not smooth.
            while t < t_out && !is_done {
                let until = chain.next_break::<K>(t).least(t_out);
                let way = Straight { brick: &brick, ray };
                let stretch = (t, until);
                let marched = if K::IS_FULL || chain.acts::<K>(casting, ray, F::of(0.5) * (t + until)) {
                    march::<F, K>(casting, &chain, front, way, voxel, stretch)
                } else {
                    march::<F, K::Plain>(casting, &chain, front, way, voxel, stretch)
                };
                (front, is_done) = (marched.front, marched.is_done);
                cast.samples += marched.samples;
                t = until;
            }
            cast.is_missing |= node.deficit > 0.0;
            if is_done {
                break;
            }
        }
        if t_out >= t_end {
            break;
        }
        t = t_out;
        at = casting.leaf_beyond(node, exit.axis, ray.point(t), ray);
    }
    cast.with_colours(front)
}
