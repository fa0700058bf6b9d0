//! Eight neighbouring rays at once, side by side as long as they pass through the same brick. Each sees the same to the bit as it
//! does alone.

use super::beside::Gathered;
use super::enhancing::Enhancing;
use super::pairs::{Pairs, add_one_by_one};
use super::paths::{Laid, Paths};
use super::segments::RAYS;
use super::straight::march;
use super::walk::Walk;
use crate::brick::Straight;
use crate::composite::Composite;
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::levels::Brick;
use crate::ray::{Line, Ray};
use crate::real::Number;
use crate::refine::Voxel;
use crate::shade::Local;
use crate::traverse::Exit;
use crate::vector::Vec3;
use crate::{Cast, Casting};
use lanes::*;
use layout::NO_NODE;

/// So many rays in a brick march alone: a packet of them takes longer.
const LONELY: usize = 1;

/// Casts up to eight rays.
#[inline(always)]
pub(crate) fn cast_packet<S: Simd, K: Kernel<Shade: Local>>(
    simd: S,
    casting: &Casting<f32>,
    rays: &[Ray<f32>],
    casts: &mut Vec<Cast<f32>>,
) {
    let last = rays.len() - 1;
    let rays = eight!(L => &rays[if L < last { L } else { last }]);
    let mut walks = eight!(L => Walk::begin(casting, rays[L]));
    for walk in &mut walks[last + 1..] {
        walk.at = NO_NODE;
    }
    let packet = Packet::new::<K>(simd, casting, &rays);
    loop {
        let at = hindmost(&walks);
        if at == NO_NODE {
            break;
        }
        packet.pass_leaf::<K>(at, &mut walks);
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

/// What eight rays keep from leaf to leaf.
struct Packet<'a, S: Simd> {
    simd: S,
    casting: &'a Casting<'a, f32>,
    line: Line<f32x8<S>>,
    chain: Chain<f32x8<S>>,
}

impl<'a, S: Simd> Packet<'a, S> {
    #[inline(always)]
    fn new<K: Kernel>(simd: S, casting: &'a Casting<f32>, rays: &[&Ray<f32>; RAYS]) -> Self {
        let line = Line {
            origin: Vec3(each!(c of 3 => {
                f32x8::load_array(simd, eight!(L => rays[L].origin_in_display.0[c]))
            })),
            direction: Vec3(each!(c of 3 => {
                f32x8::load_array(simd, eight!(L => rays[L].direction_in_display.0[c]))
            })),
        };
        Self { simd, casting, line, chain: Chain::beside::<K, f32>(casting, &line) }
    }

    /// How far each ray is the same to all enhancers, but no farther than to where it leaves its leaf, and which rays they change on
    /// the way.
    #[inline(always)]
    fn stretches<K: Kernel>(
        &self,
        walks: &[Walk<f32>; RAYS],
        exits: &[Exit<f32>; RAYS],
    ) -> ([f32; RAYS], mask32x8<S>) {
        let (simd, casting) = (self.simd, self.casting);
        let exits = eight!(L => exits[L].t);
        if !K::ENHANCES {
            return (exits, mask32x8::splat(simd, false));
        }
        let t = f32x8::load_array(simd, eight!(L => walks[L].t));
        let until = self.chain.next_break::<K, f32>(casting, t).least(f32x8::load_array(simd, exits));
        let acts = self.chain.acts::<K, f32>(casting, &self.line, splat(simd, 0.5) * (t + until));
        (until.to_array(), acts.simd_gt(splat(simd, 0.0)))
    }

    /// Takes all rays that are in a leaf through it.
    #[inline(always)]
    fn pass_leaf<K: Kernel<Shade: Local>>(&self, at: u32, walks: &mut [Walk<f32>; RAYS]) {
        let (simd, casting) = (self.simd, self.casting);
        let node = &casting.volume.nodes[at as usize];
        let mut company = 0;
        let mut bricks: [Option<(Brick<f32>, Voxel<f32>)>; RAYS] = [const { None }; RAYS];
        let mut exits = [Exit { t: 0.0, axis: 0 }; RAYS];
        for lane in 0..RAYS {
            let walk = &mut walks[lane];
            if walk.at != at {
                continue;
            }
            company += 1;
            exits[lane] = walk.exit(casting, node);
            if walk.looks(casting, node, &exits[lane]) {
                let brick = Brick::new::<K>(casting, node, walk.ray);
                bricks[lane] = Some((brick, Voxel::new(casting, node, walk.ray)));
            }
        }
        #[expect(clippy::manual_map, reason = "a closure that is not inlined loses the wider instructions")]
        let ways = eight!(L => match &bricks[L] {
            Some((brick, _)) => Some(Straight { brick, ray: walks[L].ray }),
            None => None,
        });
        loop {
            let (until, acts) = self.stretches::<K>(walks, &exits);
            let mut laid = Laid::default();
            let mut any = None;
            for lane in 0..RAYS {
                let walk = &mut walks[lane];
                let (Some(way), Some((brick, voxel))) = (ways[lane], &bricks[lane]) else { continue };
                if walk.is_done || walk.t >= exits[lane].t {
                    continue;
                }
                any = Some(way);
                let stretch = (walk.t, until[lane]);
                if company > LONELY {
                    laid.lay(lane, brick, voxel, stretch);
                } else {
                    let chain = self.chain.of::<K>(casting, lane);
                    walk.add(if acts.to_bitmask() >> lane & 1 != 0 {
                        march::<f32, K>(casting, &chain, walk.front, way, *voxel, stretch)
                    } else {
                        march::<f32, K::Plain>(casting, &chain, walk.front, way, *voxel, stretch)
                    });
                }
                walk.t = until[lane];
            }
            let Some(any) = any else { break };
            if company > LONELY {
                let paths = Paths::new::<K>(simd, &ways, &any, &laid);
                self.march::<K>(walks, paths, laid.rays, acts);
            }
            if !K::ENHANCES {
                break;
            }
        }
        for lane in 0..RAYS {
            if walks[lane].at == at {
                walks[lane].go_on(casting, node, &exits[lane]);
            }
        }
    }

    /// The twin of [`march`] for rays in the same brick, of which enhancers change those of `acts`.
    #[inline(always)]
    fn march<K: Kernel<Shade: Local>>(
        &self,
        walks: &mut [Walk<f32>; RAYS],
        mut paths: Paths<S>,
        rays: u64,
        acts: mask32x8<S>,
    ) {
        let Self { simd, casting, .. } = *self;
        let (none, one, two) = (i32x8::splat(simd, 0), i32x8::splat(simd, 1), i32x8::splat(simd, 2));
        let (mut at, mut samples) = (none, none);
        let one_by_one =
            if K::Composite::IS_OVER { None } else { Some(eight!(L => self.chain.of::<K>(casting, L))) };
        let enhancing = Enhancing { chain: &self.chain, line: self.line, acts };
        let mut gathered = Gathered::new(simd, casting, walks, enhancing);
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
            let ended = if let Some(chains) = &one_by_one {
                let acts = acts.to_bitmask();
                let ended = add_one_by_one::<S, K>(casting, (chains, acts), walks, &paths, &pairs, looked_at);
                mask32x8::from_bitmask(simd, ended)
            } else {
                let looked_at = mask32x8::from_bitmask(simd, looked_at);
                gathered.add::<K>(casting, &paths, &pairs, looked_at)
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
}
