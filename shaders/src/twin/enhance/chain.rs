//! The chain of enhancers along one ray: each hook calls the links in order.

use super::hooks::{self, LinkState, Place};
use crate::twin::composite::Sample;
use crate::twin::features::Features;
use crate::twin::gradient::Gradients;
use crate::twin::ray::{Ray, far};
use crate::twin::{Casting, Real, vector::Vec3};
use optics::MOST_ENHANCERS;

/// The chain of one ray.
#[derive(Clone, Copy, Debug)]
pub struct Chain<F> {
    view: Vec3<F>,
    links: [LinkState<F>; MOST_ENHANCERS],
}

impl<F: Real> Chain<F> {
    /// For a ray as it leaves the eye.
    #[inline(always)]
    pub fn start<K: Features>(casting: &Casting<F>, ray: &Ray<F>) -> Self {
        let unused = LinkState { weights: [F::ZERO; 4], breaks: [far(); 3] };
        let mut chain = Self { view: ray.direction_in_display, links: [unused; MOST_ENHANCERS] };
        if K::IS_FULL {
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
        if K::IS_FULL {
            for at in self.links.iter().flat_map(|link| link.breaks) {
                next = if at > t { next.least(at) } else { next };
            }
        }
        next
    }

    /// How much the links make samples around t vary within a step; 0 if none looks at gradients.
    #[inline(always)]
    pub fn spread<K: Features>(&self, casting: &Casting<F>, t: F) -> F {
        let mut sum = F::ZERO;
        if K::IS_FULL {
            for (i, kind) in casting.needs.chain.kinds().enumerate() {
                sum = sum + hooks::spread(kind, &casting.scene.links[i], &self.links[i], t);
            }
        }
        sum
    }

    /// A segment around t between two scalars, after all links.
    #[inline(always)]
    pub fn enhance<K: Features>(
        &self,
        casting: &Casting<F>,
        plain: Sample<F>,
        (ray, t): (&Ray<F>, F),
        scalars: (F, F),
        gradients: &Gradients<F>,
    ) -> Sample<F> {
        if !K::IS_FULL || casting.needs.chain.is_empty() {
            return plain;
        }
        let has_importance = K::READS_IMPORTANCE;
        let point = ray.point_in_display(t);
        let place = Place { point, gradient: gradients.at, scalars, view: self.view, has_importance };
        self.enhance_at(casting, plain, &place)
    }

    /// Not inlined: it is called from many places, and rarely.
    #[inline(never)]
    fn enhance_at(&self, casting: &Casting<F>, mut sample: Sample<F>, place: &Place<F>) -> Sample<F> {
        for (i, kind) in casting.needs.chain.kinds().enumerate() {
            sample = hooks::at(kind, &casting.scene.links[i], &self.links[i], sample, place);
        }
        sample
    }
}
