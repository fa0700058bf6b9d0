//! The chain of enhancers along a ray, or along eight side by side: each hook calls the links in order.

use super::hooks::{self, LinkState};
use super::link::alike;
use super::place::Segment;
use crate::composite::Sample;
use crate::features::Features;
use crate::ray::{FAR, Line, Ray, far};
use crate::real::Number;
use crate::{Casting, Real, vector::Vec3};
use lanes::*;
use optics::MOST_ENHANCERS;

/// The chain of a ray, or of eight.
#[derive(Clone, Copy, Debug)]
pub struct Chain<N> {
    view: Vec3<N>,
    looks_at_gradients: bool,
    links: [LinkState<N>; MOST_ENHANCERS],
}

impl<F: Real> Chain<F> {
    /// For a ray as it leaves the eye.
    #[inline(always)]
    pub fn start<K: Features>(casting: &Casting<F>, ray: &Ray<F>) -> Self {
        let line = ray.line();
        let mut chain = Self::idle::<K, F>(casting, &line);
        if K::ENHANCES {
            chain.start_apart(casting, &line);
        }
        chain
    }

    /// Not inlined: it is called from many places.
    #[inline(never)]
    fn start_apart(&mut self, casting: &Casting<F>, line: &Line<F>) {
        self.start_links(casting, line);
    }

    /// The breaks again, for another straight path.
    #[inline(never)]
    pub fn follow(&mut self, casting: &Casting<F>, ray: &Ray<F>) {
        self.follow_line(casting, &ray.line());
    }

    /// Segments of a ray, or of the rays before and beyond a turn, after all links.
    #[inline(always)]
    pub fn enhance<K: Features, const COUNT: usize>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<F>; COUNT],
        segments: &[Segment<'_, F>; COUNT],
    ) {
        if K::IS_FULL && !casting.needs.chain.is_empty() {
            self.enhance_apart::<K, COUNT>(casting, samples, segments);
        } else {
            self.enhance_here::<K, F, COUNT>(casting, samples, segments);
        }
    }

    /// Not inlined: there is much of it in kernels with everything.
    #[inline(never)]
    fn enhance_apart<K: Features, const COUNT: usize>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<F>; COUNT],
        segments: &[Segment<'_, F>; COUNT],
    ) {
        self.enhance_here::<K, F, COUNT>(casting, samples, segments);
    }
}

impl<S: Simd> Chain<f32x8<S>> {
    /// That of one of eight rays.
    #[inline(always)]
    pub fn of<K: Features>(&self, casting: &Casting<f32>, lane: usize) -> Chain<f32> {
        let mut links = [LinkState { weights: [0.0; 4], breaks: [far(); 3] }; MOST_ENHANCERS];
        let used = if K::ENHANCES { casting.needs.chain.kinds().count() } else { 0 };
        for (link, LinkState { weights, breaks }) in links.iter_mut().zip(&self.links).take(used) {
            *link = LinkState {
                weights: each!(c of 4 => weights[c][lane]),
                breaks: each!(c of 3 => breaks[c][lane]),
            };
        }
        let view = Vec3(each!(c of 3 => self.view.0[c][lane]));
        Chain { view, looks_at_gradients: self.looks_at_gradients, links }
    }
}

impl<N: Number> Chain<N> {
    /// For rays side by side as they leave the eye.
    #[inline(always)]
    pub fn beside<K: Features, F: Real>(casting: &Casting<F>, line: &Line<N>) -> Self {
        let mut chain = Self::idle::<K, F>(casting, line);
        if K::ENHANCES {
            chain.start_links(casting, line);
        }
        chain
    }

    /// Before its links start.
    #[inline(always)]
    fn idle<K: Features, F: Real>(casting: &Casting<F>, line: &Line<N>) -> Self {
        let (view, number) = (line.direction, line.direction.0[0]);
        let unused = LinkState { weights: [number.alike(0.0); 4], breaks: [number.alike(FAR); 3] };
        let looks_at_gradients = K::ENHANCES && casting.needs.chain.needs_gradient();
        Self { view, looks_at_gradients, links: [unused; MOST_ENHANCERS] }
    }

    #[inline(always)]
    fn start_links<F: Real>(&mut self, casting: &Casting<F>, line: &Line<N>) {
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            let link = alike(self.view.0[0], &casting.scene.links[i]);
            self.links[i].weights = hooks::start(kind, &link, self.view);
        }
        self.follow_line(casting, line);
    }

    #[inline(always)]
    fn follow_line<F: Real>(&mut self, casting: &Casting<F>, line: &Line<N>) {
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            let link = alike(self.view.0[0], &casting.scene.links[i]);
            self.links[i].breaks = hooks::breaks(kind, &link, self.view, line);
        }
    }

    /// The first break beyond t.
    #[inline(always)]
    pub fn next_break<K: Features, F: Real>(&self, casting: &Casting<F>, t: N) -> N {
        let mut next = t.alike(FAR);
        if K::ENHANCES {
            for (i, _) in casting.needs.chain.kinds().enumerate() {
                for at in self.links[i].breaks {
                    next = t.choose(at, next.least(at), next);
                }
            }
        }
        next
    }

    /// Above 0 if any link changes samples of a straight stretch around t without breaks.
    #[inline(always)]
    pub fn acts<K: Features, F: Real>(&self, casting: &Casting<F>, line: &Line<N>, t: N) -> N {
        let mut acts = t.alike(0.0);
        if K::ENHANCES {
            let at = (line.point(t), t);
            for (i, kind) in casting.needs.chain.kinds().enumerate() {
                let link = alike(t, &casting.scene.links[i]);
                acts = acts.most(hooks::acts(kind, &link, &self.links[i], at));
            }
        }
        acts
    }

    /// Above 0 if any link looks at the gradient around t.
    #[inline(always)]
    pub fn looks<K: Features, F: Real>(&self, casting: &Casting<F>, t: N) -> N {
        let mut looks = t.alike(0.0);
        if K::ENHANCES && self.looks_at_gradients {
            for (i, kind) in casting.needs.chain.kinds().enumerate() {
                looks = looks.most(hooks::looks(kind, &self.links[i], t));
            }
        }
        looks
    }

    /// Segments after all links, link by link, so that each finds its constants once.
    #[inline(always)]
    pub fn enhance_here<K: Features, F: Real, const COUNT: usize>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<N>; COUNT],
        segments: &[Segment<'_, N>; COUNT],
    ) {
        if !K::ENHANCES {
            return;
        }
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            let link = alike(segments[0].t, &casting.scene.links[i]);
            let seen = (self.view, K::READS_IMPORTANCE);
            hooks::at(kind, &link, &self.links[i], samples, segments, seen);
        }
    }
}
