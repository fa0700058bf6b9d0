//! The chain of enhancers along one ray: each hook calls the links in order.

use super::hooks::{self, LinkState, Place};
use crate::composite::Sample;
use crate::features::Features;
use crate::ray::{Ray, far};
use crate::{Casting, Real, vector::Vec3};
use optics::MOST_ENHANCERS;

/// A segment that enhancers change.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a, F> {
    /// The straight way that it lies on.
    pub ray: &'a Ray<F>,
    /// Its middle.
    pub t: F,
    /// Metres.
    pub length: F,
    /// The scalars at its ends.
    pub scalars: (F, F),
    /// In its middle, per finest voxel, display frame; only where [`Chain::looks`] there.
    pub gradient: Vec3<F>,
}

/// The chain of one ray.
#[derive(Clone, Copy, Debug)]
pub struct Chain<F> {
    view: Vec3<F>,
    looks_at_gradients: bool,
    links: [LinkState<F>; MOST_ENHANCERS],
}

impl<F: Real> Chain<F> {
    /// For a ray as it leaves the eye.
    #[inline(always)]
    pub fn start<K: Features>(casting: &Casting<F>, ray: &Ray<F>) -> Self {
        let unused = LinkState { weights: [F::ZERO; 4], breaks: [far(); 3] };
        let looks_at_gradients = K::ENHANCES && casting.needs.chain.needs_gradient();
        let mut chain =
            Self { view: ray.direction_in_display, looks_at_gradients, links: [unused; MOST_ENHANCERS] };
        if K::ENHANCES {
            chain.start_links(casting, ray);
        }
        chain
    }

    #[inline(never)]
    fn start_links(&mut self, casting: &Casting<F>, ray: &Ray<F>) {
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            self.links[i].weights = hooks::start(kind, &casting.scene.links[i], self.view);
        }
        self.follow(casting, ray);
    }

    /// The breaks again, for another straight path.
    #[inline(never)]
    pub fn follow(&mut self, casting: &Casting<F>, ray: &Ray<F>) {
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            self.links[i].breaks = hooks::breaks(kind, &casting.scene.links[i], self.view, ray);
        }
    }

    /// The first break beyond t.
    #[inline(always)]
    pub fn next_break<K: Features>(&self, t: F) -> F {
        let mut next: F = far();
        if K::ENHANCES {
            for at in self.links.iter().flat_map(|link| link.breaks) {
                next = if at > t { next.least(at) } else { next };
            }
        }
        next
    }

    /// Whether any link changes samples of a straight stretch around t without breaks.
    #[inline(always)]
    pub fn acts<K: Features>(&self, casting: &Casting<F>, ray: &Ray<F>, t: F) -> bool {
        let point = ray.point_in_display(t);
        let acts = |(i, kind)| hooks::acts(kind, &casting.scene.links[i], &self.links[i], (point, t));
        K::ENHANCES && casting.needs.chain.kinds().enumerate().any(acts)
    }

    /// Whether any link looks at the gradient around t.
    #[inline(always)]
    pub fn looks<K: Features>(&self, casting: &Casting<F>, t: F) -> bool {
        let looks = |(i, kind)| hooks::looks(kind, &self.links[i], t);
        K::ENHANCES && self.looks_at_gradients && casting.needs.chain.kinds().enumerate().any(looks)
    }

    /// Segments of a ray, or of the rays before and beyond a turn, after all links.
    #[inline(always)]
    pub fn enhance<K: Features, const N: usize>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<F>; N],
        segments: [Segment<F>; N],
    ) {
        if !K::ENHANCES || casting.needs.chain.is_empty() {
            return;
        }
        if K::IS_FULL {
            self.enhance_apart::<K>(casting, samples, &segments);
        } else {
            self.enhance_here::<K>(casting, samples, &segments);
        }
    }

    /// Not inlined: there is much of it in kernels with everything.
    #[inline(never)]
    fn enhance_apart<K: Features>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<F>],
        segments: &[Segment<F>],
    ) {
        self.enhance_here::<K>(casting, samples, segments);
    }

    /// Link by link, so that each finds its constants once.
    #[inline(always)]
    fn enhance_here<K: Features>(
        &self,
        casting: &Casting<F>,
        samples: &mut [Sample<F>],
        segments: &[Segment<F>],
    ) {
        let place = |segment: &Segment<F>| Place {
            point: segment.ray.point_in_display(segment.t),
            reach: segment.ray.direction_in_display * (F::of(0.5) * segment.length),
            gradient: segment.gradient,
            scalars: segment.scalars,
            view: self.view,
            has_importance: K::READS_IMPORTANCE,
        };
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            let all = samples.iter_mut().zip(segments);
            hooks::at(kind, &casting.scene.links[i], &self.links[i], all, place);
        }
    }
}
