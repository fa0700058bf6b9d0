//! Eight neighbouring rays at once, side by side as long as they pass through the same brick. Each sees the same to the bit as it
//! does alone.

use super::beside::{Gathered, Pairs, add_one_by_one};
use super::paths::{Laid, Paths};
use super::segments::RAYS;
use super::straight::march;
use super::walk::Walk;
use crate::brick::Straight;
use crate::composite::Composite;
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::refine::Voxel;
use crate::shade::Local;
use crate::traverse::Exit;
use crate::{Cast, Casting, ray::Ray};
use lanes::*;
use layout::NO_NODE;

/// So many rays in a brick march alone: a packet of them takes longer.
const LONELY: usize = 1;

/// Casts up to eight rays, with a kernel without enhancers.
#[inline(always)]
pub(crate) fn cast_packet<S: Simd, K: Kernel<Shade: Local>>(
    simd: S,
    casting: &Casting<f32>,
    rays: &[Ray<f32>],
    casts: &mut Vec<Cast<f32>>,
) {
    let last = rays.len() - 1;
    let mut walks = eight!(L => Walk::begin(casting, &rays[if L < last { L } else { last }]));
    for walk in &mut walks[last + 1..] {
        walk.at = NO_NODE;
    }
    // No link of it is ever asked.
    let chain = Chain::start::<K>(casting, &rays[0]);
    loop {
        let at = hindmost(&walks);
        if at == NO_NODE {
            break;
        }
        pass_leaf::<S, K>(simd, casting, &chain, at, &mut walks);
    }
    for walk in &walks[..=last] {
        casts.push(walk.end());
    }
}

/// The leaf of the ray that is furthest behind: the others wait for it.
#[inline(always)]
fn hindmost(walks: &[Walk<f32>; RAYS]) -> u32 {
    let (mut at, mut t) = (NO_NODE, f32::INFINITY);
    for walk in walks {
        if walk.at != NO_NODE && walk.t < t {
            (at, t) = (walk.at, walk.t);
        }
    }
    at
}

/// Takes all rays that are in a leaf through it.
#[inline(always)]
fn pass_leaf<S: Simd, K: Kernel<Shade: Local>>(
    simd: S,
    casting: &Casting<f32>,
    chain: &Chain<f32>,
    at: u32,
    walks: &mut [Walk<f32>; RAYS],
) {
    let node = &casting.volume.nodes[at as usize];
    let mut company = 0;
    for walk in &*walks {
        company += usize::from(walk.at == at);
    }
    let mut laid = Laid::default();
    let mut bricks: [Option<Brick<f32>>; RAYS] = [const { None }; RAYS];
    let mut exits = [Exit { t: 0.0, axis: 0 }; RAYS];
    for lane in 0..RAYS {
        let walk = &mut walks[lane];
        if walk.at != at {
            continue;
        }
        exits[lane] = walk.exit(casting, node);
        if !walk.looks(casting, node, &exits[lane]) {
            continue;
        }
        let brick = Brick::new::<K>(casting, node, walk.ray);
        let voxel = Voxel::new(casting, node, walk.ray);
        let stretch = (walk.t, exits[lane].t);
        if company <= LONELY {
            let way = Straight { brick: &brick, ray: walk.ray };
            walk.add(march::<f32, K>(casting, chain, walk.front, way, voxel, stretch));
        } else {
            laid.lay(lane, &brick, &voxel, stretch);
            bricks[lane] = Some(brick);
        }
    }
    #[expect(clippy::manual_map, reason = "a closure that is not inlined loses the wider instructions")]
    let ways = eight!(L => match &bricks[L] {
        Some(brick) => Some(Straight { brick, ray: walks[L].ray }),
        None => None,
    });
    if let Some(any) = ways.iter().flatten().next() {
        let paths = Paths::new::<K>(simd, &ways, any, &laid);
        march_side_by_side::<S, K>(simd, casting, chain, walks, paths, laid.rays);
    }
    for lane in 0..RAYS {
        if walks[lane].at == at {
            walks[lane].go_on(casting, node, &exits[lane]);
        }
    }
}

/// The twin of [`march`] for rays in the same brick.
#[inline(always)]
fn march_side_by_side<S: Simd, K: Kernel<Shade: Local>>(
    simd: S,
    casting: &Casting<f32>,
    chain: &Chain<f32>,
    walks: &mut [Walk<f32>; RAYS],
    mut paths: Paths<S>,
    rays: u64,
) {
    let (none, one, two) = (i32x8::splat(simd, 0), i32x8::splat(simd, 1), i32x8::splat(simd, 2));
    let (mut at, mut samples) = (none, none);
    let mut gathered = Gathered::new(simd, casting, walks);
    let mut all_ended: mask32x8<S> = mask32x8::splat(simd, false);
    let mut known = splat(simd, 0.0);
    let mut is_known: mask32x8<S> = mask32x8::splat(simd, false);
    let rays = mask32x8::from_bitmask(simd, rays);
    let mut count = rays.select(paths.lay_out::<K>(casting, paths.begin(), rays), none);
    loop {
        let under_way = at.simd_lt(count) & !gathered.waiting();
        if !under_way.any_true() {
            if !gathered.waiting().any_true() {
                break;
            }
            let ended = gathered.add_waiting::<K>(casting, &paths);
            count = ended.select(none, count);
            all_ended |= ended;
            continue;
        }
        let t0 = paths.t(at);
        if paths.has_fractions() {
            // Steps too short for t to grow by them are counted instead, or there would be no end.
            let moved = under_way & paths.beyond(t0);
            if moved.any_true() {
                count = moved.select(paths.lay_out::<K>(casting, t0, moved), count);
                at = moved.select(none, at);
            }
        }
        let blind = under_way & !paths.see(t0);
        if blind.any_true() {
            // Others wait, until all that are left may see something.
            at = blind.select(at + paths.pairs_unseen(t0), at);
            is_known &= !blind;
            continue;
        }
        at = under_way.select(at + one, at);
        let fresh = under_way & !is_known;
        let mut s0 = known;
        if fresh.any_true() {
            s0 = is_known.select(known, paths.scalars::<K>(casting, t0, fresh));
            samples += fresh.select(one, none);
        }
        let t1 = t0 + paths.step;
        let s1 = paths.scalars::<K>(casting, t1, under_way);
        let s2 = paths.scalars::<K>(casting, t0 + splat(simd, 2.0) * paths.step, under_way);
        samples += under_way.select(two, none);
        (known, is_known) = (under_way.select(s2, known), is_known | under_way);
        let mut spreads = [splat(simd, 0.0); 2];
        if K::BLENDS && casting.needs.spreads {
            spreads[0] = paths.spreads(t0 + splat(simd, 0.5) * paths.step);
            spreads[1] = paths.spreads(t0 + splat(simd, 1.5) * paths.step);
        }
        let pairs = Pairs::new([t0, t1], paths.step, [s0, s1, s2], spreads);
        let looked_at = under_way.to_bitmask() & !pairs.vacant(casting);
        if looked_at == 0 {
            continue;
        }
        let ended = if K::Composite::IS_OVER {
            let looked_at = mask32x8::from_bitmask(simd, looked_at);
            gathered.add::<K>(casting, &paths, &pairs, looked_at)
        } else {
            let ended = add_one_by_one::<S, K>(casting, chain, walks, &paths, &pairs, looked_at);
            mask32x8::from_bitmask(simd, ended)
        };
        count = ended.select(none, count);
        all_ended |= ended;
    }
    samples += gathered.samples;
    if K::Composite::IS_OVER {
        gathered.give_back(walks);
    }
    let ended = all_ended.to_bitmask();
    for (lane, walk) in walks.iter_mut().enumerate() {
        walk.cast.samples += samples[lane] as u32;
        walk.is_done |= ended >> lane & 1 != 0;
    }
}
