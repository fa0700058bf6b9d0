//! What enhancers change of eight rays in the same brick, side by side.

use super::pairs::Pairs;
use super::paths::Paths;
use crate::composite::Sample;
use crate::enhance::{Chain, Segment};
use crate::kernel::Kernel;
use crate::ray::Line;
use crate::refine::Pair;
use crate::vector::Vec3;
use crate::{Casting, real::Number};
use lanes::*;

/// The enhancers of eight rays, on the stretches that they are on.
pub(super) struct Enhancing<'a, S: Simd> {
    pub(super) chain: &'a Chain<f32x8<S>>,
    pub(super) line: Line<f32x8<S>>,
    /// The rays of which they change samples there.
    pub(super) acts: mask32x8<S>,
}

/// Gradients that enhancers look at, in the middle of each step of pairs.
pub(super) struct Seen<S: Simd> {
    /// Those of which they look at any.
    pub(super) rays: mask32x8<S>,
    /// Zero of all other rays, and where nothing shows.
    pub(super) gradients: [Vec3<f32x8<S>>; 2],
}

impl<S: Simd> Enhancing<'_, S> {
    /// The rays of which any link looks at the gradient around `t`.
    #[inline(always)]
    pub(super) fn looks<K: Kernel>(
        &self,
        casting: &Casting<f32>,
        t: f32x8<S>,
        rays: mask32x8<S>,
    ) -> mask32x8<S> {
        let looks = self.chain.looks::<K, f32>(casting, t);
        looks.simd_gt(t.alike(0.0)) & rays & self.acts
    }

    /// Changes what pairs of some rays show: the twin of what `add_pair` does with a chain.
    #[inline(always)]
    pub(super) fn change<K: Kernel>(
        &self,
        casting: &Casting<f32>,
        paths: &Paths<S>,
        pairs: &Pairs<S>,
        pair: &mut Pair<f32x8<S>>,
        rays: mask32x8<S>,
    ) -> Seen<S> {
        let ([t0, t1], length, [s0, s1, s2]) = (pairs.t, pairs.length, pairs.scalars);
        let zero = t0.alike(0.0);
        let nothing = Vec3::splat(zero);
        let none: mask32x8<S> = mask32x8::splat(t0.token(), false);
        let mut seen = Seen { rays: none, gradients: [nothing; 2] };
        if !K::ENHANCES || !(self.acts & rays).any_true() {
            return seen;
        }
        seen.rays = self.looks::<K>(casting, t1, rays);
        let (half, both) = (t0.alike(0.5) * length, t0.alike(2.0) * length);
        let shows = pair.reach.k[3].most(pair.both.k[3]).simd_gt(zero) & seen.rays;
        let mut between = nothing;
        if shows.any_true() {
            seen.gradients = [
                paths.gradients::<K>(casting, t0 + half, shows),
                paths.gradients::<K>(casting, t1 + half, shows),
            ];
            between = (seen.gradients[0] + seen.gradients[1]) * t0.alike(0.5);
        }
        let (line, [first, second]) = (&self.line, seen.gradients);
        let segments = [
            Segment { line, t: t0 + half, length, scalars: (s0, s1), gradient: first },
            Segment { line, t: t1 + half, length, scalars: (s1, s2), gradient: second },
            Segment { line, t: t1, length: both, scalars: (s0, s2), gradient: between },
            Segment { line, t: t1, length: both, scalars: pairs.range, gradient: between },
        ];
        let mut samples = [pair.first, pair.second, pair.both, pair.reach];
        self.change_samples::<K, 4>(casting, &mut samples, &segments, rays);
        [pair.first, pair.second, pair.both, pair.reach] = samples;
        seen
    }

    /// Changes what parts of steps of some rays show.
    #[inline(always)]
    pub(super) fn change_part<K: Kernel>(
        &self,
        casting: &Casting<f32>,
        sample: &mut Sample<f32x8<S>>,
        segment: &Segment<'_, f32x8<S>>,
        rays: mask32x8<S>,
    ) {
        if K::ENHANCES && (self.acts & rays).any_true() {
            let mut samples = [*sample];
            self.change_samples::<K, 1>(casting, &mut samples, std::array::from_ref(segment), rays);
            [*sample] = samples;
        }
    }

    /// Changes samples of some rays: those of which nothing acts stay as they are.
    #[inline(always)]
    fn change_samples<K: Kernel, const COUNT: usize>(
        &self,
        casting: &Casting<f32>,
        samples: &mut [Sample<f32x8<S>>; COUNT],
        segments: &[Segment<'_, f32x8<S>>; COUNT],
        rays: mask32x8<S>,
    ) {
        let plain = *samples;
        self.chain.enhance_here::<K, f32, COUNT>(casting, samples, segments);
        let acts = self.acts;
        if (rays & !acts).any_true() {
            for (sample, plain) in samples.iter_mut().zip(&plain) {
                sample.k = each!(c of 4 => acts.select(sample.k[c], plain.k[c]));
                sample.lit = acts.select(sample.lit, plain.lit);
                sample.brightness = acts.select(sample.brightness, plain.brightness);
            }
        }
    }
}
