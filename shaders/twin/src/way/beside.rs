//! What pairs of steps of eight rays in the same brick add, side by side, where segments lie one behind the other.

use super::enhancing::{Enhancing, Seen};
use super::pairs::Pairs;
use super::paths::Paths;
use super::segments::{RAYS, Segment, mean};
use super::walk::Walk;
use crate::brick::segment_light;
use crate::composite::{Accumulated, Sample};
use crate::enhance::Segment as Part;
use crate::kernel::Kernel;
use crate::refine::parts_of_step;
use crate::shade::{Lighting, Lit, Local, Shade};
use crate::vector::Vec3;
use crate::{Casting, real::Number};
use lanes::*;

/// What eight rays have gathered.
pub(super) struct Gathered<'a, S: Simd> {
    simd: S,
    pub(super) front: Accumulated<f32x8<S>>,
    /// Samples between those of pairs.
    pub(super) samples: i32x8<S>,
    lit: Lit<f32x8<S>>,
    enhancing: Enhancing<'a, S>,
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

impl<'a, S: Simd> Gathered<'a, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        casting: &Casting<f32>,
        walks: &[Walk<f32>; RAYS],
        enhancing: Enhancing<'a, S>,
    ) -> Self {
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
                direction: enhancing.line.direction,
            },
            enhancing,
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
        let mut pair = pairs.shown::<K>(casting, rays);
        let seen = self.enhancing.change::<K>(casting, paths, pairs, &mut pair, rays);
        let thickness = splat(simd, scene.extinction_per_metre) * pairs.length;
        let spread = splat(simd, K::Shade::spread(casting.needs) as f32);
        let (visible, tolerance) = (one - self.front.alpha, splat(simd, scene.tolerance));
        let parts = parts_of_step(pair.emitted(), thickness, visible, spread, tolerance).most(one);
        let in_parts = parts.simd_gt(one) & rays;
        let whole = rays & !in_parts;
        if in_parts.any_true() {
            self.waiting.add(pairs, parts, in_parts);
        }
        if whole.any_true() {
            let zero = splat(simd, 0.0);
            let (first, second) = (pair.first, pair.second);
            let shows = first.k[3].most(second.k[3]).simd_gt(zero) & whole;
            let lights = self.lights::<K>(casting, paths, pairs.t[1], &seen, shows);
            // See `Composite::is_clear`.
            self.add_segments(&first, thickness, lights[0], whole & !first.k[3].simd_le(zero));
            self.add_segments(&second, thickness, lights[1], whole & !second.k[3].simd_le(zero));
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
        let looks = self.enhancing.looks::<K>(casting, t1, rays);
        for (t, from, to) in [(t0, s0, s1), (t1, s1, s2)] {
            self.add_in_parts::<K>(casting, paths, (t, length, parts), (from, to), (rays, looks));
        }
        self.waiting.rays = mask32x8::splat(self.simd, false);
        self.ended(casting, rays)
    }

    #[inline(always)]
    fn ended(&self, casting: &Casting<f32>, rays: mask32x8<S>) -> mask32x8<S> {
        let one = splat(self.simd, 1.0);
        (one - self.front.alpha).simd_lt(splat(self.simd, casting.scene.termination)) & rays
    }

    /// The light on either segment of pairs with their middles at `t` of some rays: where enhancers look at gradients, each has its
    /// own; else that in the middle of the pair serves both.
    #[inline(always)]
    fn lights<K: Kernel<Shade: Local>>(
        &self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        t: f32x8<S>,
        seen: &Seen<S>,
        rays: mask32x8<S>,
    ) -> [Lighting<f32x8<S>>; 2] {
        if !K::Shade::reads_gradients(casting.needs) {
            return [self.unlit(); 2];
        }
        let (own, alike) = (rays & seen.rays, rays & !seen.rays);
        let mut lights = [self.unlit(); 2];
        if alike.any_true() {
            let light = self.light::<K>(casting, paths.gradients::<K>(casting, t, alike), alike);
            lights = [light; 2];
        }
        if own.any_true() {
            for (light, gradients) in lights.iter_mut().zip(seen.gradients) {
                let Lighting { body, highlight } = self.light::<K>(casting, gradients, own);
                light.body = own.select(body, light.body);
                light.highlight = own.select(highlight, light.highlight);
            }
        }
        lights
    }

    /// Plain colours.
    #[inline(always)]
    fn unlit(&self) -> Lighting<f32x8<S>> {
        Lighting { body: splat(self.simd, 1.0), highlight: splat(self.simd, 0.0) }
    }

    /// The light on segments of some rays, by the gradients there: plain colours on all others.
    #[inline(always)]
    fn light<K: Kernel<Shade: Local>>(
        &self,
        casting: &Casting<f32>,
        gradients: Vec3<f32x8<S>>,
        rays: mask32x8<S>,
    ) -> Lighting<f32x8<S>> {
        let material = casting.scene.material;
        let material = each!(c of 4 => splat(self.simd, material[c]));
        let (light, unlit) = (K::Shade::light(&self.lit, gradients, material), self.unlit());
        Lighting {
            body: rays.select(light.body, unlit.body),
            highlight: rays.select(light.highlight, unlit.highlight),
        }
    }

    /// Adds a segment of some rays.
    #[inline(always)]
    fn add_segments(
        &mut self,
        sample: &Sample<f32x8<S>>,
        thickness: f32x8<S>,
        light: Lighting<f32x8<S>>,
        rays: mask32x8<S>,
    ) {
        let front = self.front;
        let light = segment_light(sample.k, (sample.lit, sample.brightness), thickness, light);
        let Accumulated { rgb, alpha, importance } = front.over(light);
        self.front = Accumulated {
            rgb: Vec3(each!(c of 3 => rays.select(rgb.0[c], front.rgb.0[c]))),
            alpha: rays.select(alpha, front.alpha),
            importance,
        };
    }

    /// Adds a step of some rays, split into parts, as far as anything can be seen: the twin of `add_parts`. Of those that `look`,
    /// enhancers look at gradients.
    #[inline(always)]
    fn add_in_parts<K: Kernel<Shade: Local>>(
        &mut self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        (t0, length, parts): (f32x8<S>, f32x8<S>, f32x8<S>),
        (mut from, end): (f32x8<S>, f32x8<S>),
        (rays, look): (mask32x8<S>, mask32x8<S>),
    ) {
        let (simd, scene) = (self.simd, casting.scene);
        let is_lit = K::Shade::reads_gradients(casting.needs);
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
            let mut sample = Sample::plain(mean(casting.tables, &segment, going.to_bitmask()));
            // See `Composite::is_clear`.
            let shows = !sample.k[3].simd_le(zero) & going;
            let dense = sample.k[3].simd_gt(zero) & going;
            let read = if is_lit { dense } else { dense & look };
            let mut gradients = Vec3::splat(zero);
            if read.any_true() {
                gradients = paths.gradients::<K>(casting, middle, read);
            }
            let (line, gradient) = (&self.enhancing.line, gradients);
            let segment = Part { line, t: middle, length: part, scalars: (from, to), gradient };
            self.enhancing.change_part::<K>(casting, &mut sample, &segment, shows);
            let mut light = self.unlit();
            if is_lit && read.any_true() {
                light = self.light::<K>(casting, gradients, sample.k[3].simd_gt(zero) & read);
            }
            self.add_segments(&sample, thickness, light, shows);
            let ended = (one - self.front.alpha).simd_lt(splat(simd, scene.termination)) & shows;
            going = inner & !ended;
            from = to;
            number += one;
        }
    }
}
