//! Pairs of steps of eight rays in the same brick, side by side, and what they add.

use super::paths::Paths;
use super::segments::{Places, RAYS, Segment, first_of, mean, means};
use super::walk::Walk;
use crate::brick::{PairOfSteps, Straight, add_pair, segment_light};
use crate::composite::{Accumulated, Composite};
use crate::enhance::Chain;
use crate::kernel::Kernel;
use crate::refine::{Emitted, parts_of_step, scalars_in_reach};
use crate::shade::{Lighting, Lit, Local, Shade};
use crate::tables::is_vacant_between;
use crate::vector::Vec3;
use crate::{Casting, real::Number};
use lanes::*;

/// A pair of steps of each ray.
pub(super) struct Pairs<S: Simd> {
    t: [f32x8<S>; 2],
    length: f32x8<S>,
    scalars: [f32x8<S>; 3],
    range: (f32x8<S>, f32x8<S>),
    spreads: [f32x8<S>; 2],
}

impl<S: Simd> Pairs<S> {
    /// What they emit: see [`crate::refine::Pair`].
    #[inline(always)]
    fn emitted<K: Kernel>(&self, casting: &Casting<f32>, rays: mask32x8<S>) -> Emitted<f32x8<S>> {
        let ([s0, s1, s2], (low, high)) = (self.scalars, self.range);
        let are_wide = K::BLENDS && casting.needs.spreads;
        let segments = if are_wide {
            let [a, b] = self.spreads;
            [
                Segment::over([s0, s1], a),
                Segment::over([s1, s2], b),
                Segment::over([s0, s2], a.alike(0.5) * (a + b)),
                Segment::over([low, high], a.most(b)),
            ]
        } else {
            [
                Segment::between([s0, s1]),
                Segment::between([s1, s2]),
                Segment::between([s0, s2]),
                Segment::between([low, high]),
            ]
        };
        let [first, second, both, reach] = means(casting.tables, &segments, !are_wide, rays.to_bitmask());
        Emitted { first, second, both, reach }
    }

    #[inline(always)]
    pub(super) fn new(
        t: [f32x8<S>; 2],
        length: f32x8<S>,
        scalars: [f32x8<S>; 3],
        spreads: [f32x8<S>; 2],
    ) -> Self {
        let [s0, s1, s2] = scalars;
        Self { t, length, scalars, range: scalars_in_reach(s0, s1, s2), spreads }
    }

    /// The rays of which nothing that they may have met changes a picture: see [`crate::tables::is_vacant_around`].
    #[inline(always)]
    pub(super) fn vacant(&self, casting: &Casting<f32>) -> u64 {
        let (low, high) = self.range;
        let spread = self.spreads[0].most(self.spreads[1]);
        let low = Places::of((low - spread).most(low.alike(0.0)));
        let high = Places::of((high + spread).least(high.alike(1.0)));
        let mut vacant = 0;
        for lane in 0..RAYS {
            // Those of a ray that is nowhere are none.
            let cells = [low.cell[lane].max(0) as usize, high.cell[lane].max(0) as usize];
            vacant |= u64::from(is_vacant_between(&casting.tables.cells, cells[0], cells[1])) << lane;
        }
        vacant
    }

    #[inline(always)]
    fn of<'a>(&self, lane: usize, way: Straight<'a, f32>) -> PairOfSteps<f32, Straight<'a, f32>> {
        PairOfSteps {
            first: way,
            second: way,
            t: [self.t[0][lane], self.t[1][lane]],
            length: self.length[lane],
            scalars: [self.scalars[0][lane], self.scalars[1][lane], self.scalars[2][lane]],
            range: (self.range.0[lane], self.range.1[lane]),
            spreads: [self.spreads[0][lane], self.spreads[1][lane]],
        }
    }
}

/// Adds the pairs of some rays one by one. Returns those of which nothing that follows can be seen.
#[inline(always)]
pub(super) fn add_one_by_one<S: Simd, K: Kernel>(
    casting: &Casting<f32>,
    chain: &Chain<f32>,
    walks: &mut [Walk<f32>; RAYS],
    paths: &Paths<S>,
    pairs: &Pairs<S>,
    mut rays: u64,
) -> u64 {
    let mut ended = 0;
    while rays != 0 {
        let lane = first_of(&mut rays);
        let Some(way) = paths.ways[lane] else { continue };
        let walk = &mut walks[lane];
        let (front, between) = add_pair::<f32, K, _>(casting, chain, walk.front, &pairs.of(lane, way));
        walk.front = front;
        walk.cast.samples += between;
        ended |= u64::from(K::Composite::still_to_come(casting, front) < casting.scene.termination) << lane;
    }
    ended
}

/// What eight rays have gathered, where segments lie one behind the other.
pub(super) struct Gathered<S: Simd> {
    simd: S,
    pub(super) front: Accumulated<f32x8<S>>,
    /// Samples between those of pairs.
    pub(super) samples: i32x8<S>,
    lit: Lit<f32x8<S>>,
    waiting: Waiting<S>,
}

/// Pairs of steps that are to be split: they wait until no ray goes on without, so that as many as can be are split together.
struct Waiting<S: Simd> {
    rays: mask32x8<S>,
    /// Where the steps of each begin.
    t: [f32x8<S>; 2],
    length: f32x8<S>,
    scalars: [f32x8<S>; 3],
    /// What each step is split into.
    parts: f32x8<S>,
}

impl<S: Simd> Waiting<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let (rays, zero) = (mask32x8::splat(simd, false), splat(simd, 0.0));
        Self { rays, t: [zero; 2], length: zero, scalars: [zero; 3], parts: zero }
    }

    /// Has the pairs of some rays wait as well.
    #[inline(always)]
    fn add(&mut self, pairs: &Pairs<S>, parts: f32x8<S>, rays: mask32x8<S>) {
        self.rays |= rays;
        for i in 0..2 {
            self.t[i] = rays.select(pairs.t[i], self.t[i]);
        }
        self.length = rays.select(pairs.length, self.length);
        for i in 0..3 {
            self.scalars[i] = rays.select(pairs.scalars[i], self.scalars[i]);
        }
        self.parts = rays.select(parts, self.parts);
    }
}

impl<S: Simd> Gathered<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, casting: &Casting<f32>, walks: &[Walk<f32>; RAYS]) -> Self {
        let scene = casting.scene;
        Self {
            simd,
            waiting: Waiting::none(simd),
            front: Accumulated {
                rgb: Vec3(each!(c of 3 => f32x8::load_array(simd, eight!(L => walks[L].front.rgb.0[c])))),
                alpha: f32x8::load_array(simd, eight!(L => walks[L].front.alpha)),
                importance: splat(simd, 0.0),
            },
            samples: i32x8::splat(simd, 0),
            lit: Lit {
                toward_light: Vec3(each!(c of 3 => splat(simd, scene.toward_light.0[c]))),
                half_square: splat(simd, scene.gradient_half_square),
                direction: Vec3(each!(c of 3 => {
                    f32x8::load_array(simd, eight!(L => walks[L].ray.direction_in_display.0[c]))
                })),
            },
        }
    }

    /// The rays that wait with their pairs.
    #[inline(always)]
    pub(super) fn waiting(&self) -> mask32x8<S> {
        self.waiting.rays
    }

    /// Gives it back to the rays.
    #[inline(always)]
    pub(super) fn give_back(self, walks: &mut [Walk<f32>; RAYS]) {
        let Accumulated { rgb: Vec3([r, g, b]), alpha, .. } = self.front;
        for (lane, walk) in walks.iter_mut().enumerate() {
            walk.front.rgb = Vec3([r[lane], g[lane], b[lane]]);
            walk.front.alpha = alpha[lane];
        }
    }

    /// Adds the pairs of some rays, but for those that are to be split: these wait. Returns the rays of which nothing that follows
    /// can be seen.
    #[inline(always)]
    pub(super) fn add<K: Kernel<Shade: Local>>(
        &mut self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        pairs: &Pairs<S>,
        rays: mask32x8<S>,
    ) -> mask32x8<S> {
        let (simd, scene) = (self.simd, casting.scene);
        let one = splat(simd, 1.0);
        let emitted = pairs.emitted::<K>(casting, rays);
        let thickness = splat(simd, scene.extinction_per_metre) * pairs.length;
        let spread = splat(simd, K::Shade::spread(casting.needs) as f32);
        let (visible, tolerance) = (one - self.front.alpha, splat(simd, scene.tolerance));
        let (first, second) = (emitted.first, emitted.second);
        let parts = parts_of_step(emitted, thickness, visible, spread, tolerance).most(one);
        let in_parts = parts.simd_gt(one) & rays;
        let whole = rays & !in_parts;
        if in_parts.any_true() {
            self.waiting.add(pairs, parts, in_parts);
        }
        if whole.any_true() {
            let shows = first[3].most(second[3]).simd_gt(splat(simd, 0.0)) & whole;
            let light = self.light::<K>(casting, paths, pairs.t[1], shows);
            self.add_segments(first, thickness, light, whole);
            self.add_segments(second, thickness, light, whole);
        }
        self.ended(casting, whole)
    }

    /// Adds the pairs that wait. Returns the rays of which nothing that follows can be seen.
    #[inline(always)]
    pub(super) fn add_waiting<K: Kernel<Shade: Local>>(
        &mut self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
    ) -> mask32x8<S> {
        let Waiting { rays, t: [t0, t1], length, scalars: [s0, s1, s2], parts } = self.waiting;
        for (t, from, to) in [(t0, s0, s1), (t1, s1, s2)] {
            self.add_in_parts::<K>(casting, paths, (t, length, parts), (from, to), rays);
        }
        self.waiting.rays = mask32x8::splat(self.simd, false);
        self.ended(casting, rays)
    }

    #[inline(always)]
    fn ended(&self, casting: &Casting<f32>, rays: mask32x8<S>) -> mask32x8<S> {
        let one = splat(self.simd, 1.0);
        (one - self.front.alpha).simd_lt(splat(self.simd, casting.scene.termination)) & rays
    }

    /// The light on segments at `t` of some rays: plain colours on all others.
    #[inline(always)]
    fn light<K: Kernel<Shade: Local>>(
        &self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        t: f32x8<S>,
        rays: mask32x8<S>,
    ) -> Lighting<f32x8<S>> {
        let (zero, one) = (t.alike(0.0), t.alike(1.0));
        let none = Lighting { body: one, highlight: zero };
        if !K::Shade::reads_gradients(casting.needs) || !rays.any_true() {
            return none;
        }
        let gradient = paths.gradients::<K>(casting, t, rays);
        let gradient = Vec3(each!(axis of 3 => rays.select(gradient.0[axis], zero)));
        let material = casting.scene.material;
        let material = each!(c of 4 => splat(self.simd, material[c]));
        let light = K::Shade::light(&self.lit, gradient, material);
        Lighting {
            body: rays.select(light.body, none.body),
            highlight: rays.select(light.highlight, none.highlight),
        }
    }

    /// Adds a segment of some rays. Returns those that it shows of.
    #[inline(always)]
    fn add_segments(
        &mut self,
        k: [f32x8<S>; 4],
        thickness: f32x8<S>,
        light: Lighting<f32x8<S>>,
        rays: mask32x8<S>,
    ) -> mask32x8<S> {
        let (zero, one) = (splat(self.simd, 0.0), splat(self.simd, 1.0));
        // See `Composite::is_clear`.
        let shows = !k[3].simd_le(zero) & rays;
        let front = self.front;
        let Accumulated { rgb, alpha, importance } =
            front.over(segment_light(k, (one, one), thickness, light));
        self.front = Accumulated {
            rgb: Vec3(each!(c of 3 => shows.select(rgb.0[c], front.rgb.0[c]))),
            alpha: shows.select(alpha, front.alpha),
            importance,
        };
        shows
    }

    /// Adds a step of some rays, split into parts, as far as anything can be seen: the twin of `add_parts`.
    #[inline(always)]
    fn add_in_parts<K: Kernel<Shade: Local>>(
        &mut self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        (t0, length, parts): (f32x8<S>, f32x8<S>, f32x8<S>),
        (mut from, end): (f32x8<S>, f32x8<S>),
        rays: mask32x8<S>,
    ) {
        let (simd, scene) = (self.simd, casting.scene);
        let (zero, half, one) = (splat(simd, 0.0), splat(simd, 0.5), splat(simd, 1.0));
        let part = length / parts;
        let thickness = splat(simd, scene.extinction_per_metre) * part;
        let mut going = rays;
        let mut number = one;
        while going.any_true() {
            let t = t0 + number * part;
            let inner = number.simd_lt(parts) & going;
            let mut to = end;
            if inner.any_true() {
                to = inner.select(paths.scalars::<K>(casting, t, inner), end);
                self.samples += inner.select(i32x8::splat(simd, 1), i32x8::splat(simd, 0));
            }
            let middle = t - half * part;
            let segment = if K::BLENDS && casting.needs.spreads {
                Segment::over([from, to], paths.spreads(middle))
            } else {
                Segment::between([from, to])
            };
            let k = mean(casting.tables, &segment, going.to_bitmask());
            let light = self.light::<K>(casting, paths, middle, k[3].simd_gt(zero) & going);
            let shown = self.add_segments(k, thickness, light, going);
            let ended = (one - self.front.alpha).simd_lt(splat(simd, scene.termination)) & shown;
            going = inner & !ended;
            from = to;
            number += one;
        }
    }
}
