//! The chain of enhancers along one ray: each hook calls the links in order.

use super::{Constants, band_picker, clip_plane, layer_opacity, probe};
use crate::compose::EnhancerKind;
use crate::optics::MOST_ENHANCERS;
use crate::twin::composite::{Accumulated, Composite, Sample};
use crate::twin::gradient::Gradients;
use crate::twin::kernel::Kernel;
use crate::twin::ray::{Ray, far};
use crate::twin::{Real, Scene, vector::Vec3};

/// An enhancer's state along one ray.
#[derive(Clone, Copy, Debug)]
pub struct LinkState<F> {
    /// What it has made of the ray's direction.
    pub weights: [F; 4],
    /// Where on the ray its law is not smooth; far where there is no such place.
    pub breaks: [F; 3],
}

/// Where a segment lies that enhancers look at.
#[derive(Clone, Copy, Debug)]
pub struct Place<F> {
    /// Middle of the segment, metres, display frame.
    pub point: Vec3<F>,
    /// Of the scalar there, per finest voxel, display frame.
    pub gradient: Vec3<F>,
    /// The scalars at the segment's ends.
    pub scalars: (F, F),
    /// The direction in which the ray left the eye.
    pub view: Vec3<F>,
    /// Whether the scene accumulates importance.
    pub has_importance: bool,
}

/// The chain of one ray.
#[derive(Clone, Copy, Debug)]
pub struct Chain<F> {
    view: Vec3<F>,
    links: [LinkState<F>; MOST_ENHANCERS],
}

impl<F: Real> Chain<F> {
    /// For a ray as it leaves the eye.
    #[inline(always)]
    pub fn start<K: Kernel>(scene: &Scene<F>, ray: &Ray<F>) -> Self {
        let unused = LinkState { weights: [F::ZERO; 4], breaks: [far(); 3] };
        let mut chain = Self { view: ray.direction_in_display, links: [unused; MOST_ENHANCERS] };
        if K::IS_FULL {
            chain.start_links(scene, ray);
        }
        chain
    }

    #[inline(never)]
    fn start_links(&mut self, scene: &Scene<F>, ray: &Ray<F>) {
        for (i, kind) in scene.needs.chain.kinds().enumerate() {
            self.links[i].weights = start(kind, &scene.view.links[i], self.view);
        }
        self.follow(scene, ray);
    }

    /// The breaks anew, for another straight way.
    #[inline(never)]
    pub fn follow(&mut self, scene: &Scene<F>, ray: &Ray<F>) {
        for (i, kind) in scene.needs.chain.kinds().enumerate() {
            self.links[i].breaks = breaks(kind, &scene.view.links[i], self.view, ray);
        }
    }

    /// The first break beyond t.
    #[inline(always)]
    pub fn next_break<K: Kernel>(&self, t: F) -> F {
        let mut next: F = far();
        if K::IS_FULL {
            for at in self.links.iter().flat_map(|link| link.breaks) {
                next = if at > t { next.least(at) } else { next };
            }
        }
        next
    }

    /// How much the links make samples vary within a step.
    #[inline(always)]
    pub fn spread<K: Kernel>(scene: &Scene<F>) -> F {
        let mut sum = F::ZERO;
        if K::IS_FULL {
            for (i, kind) in scene.needs.chain.kinds().enumerate() {
                sum = sum + spread(kind, &scene.view.links[i]);
            }
        }
        sum
    }

    /// A segment around t between two scalars, after all links.
    #[inline(always)]
    pub fn enhance<K: Kernel>(
        &self,
        scene: &Scene<F>,
        plain: Sample<F>,
        (ray, t): (&Ray<F>, F),
        scalars: (F, F),
        gradients: &Gradients<F>,
    ) -> Sample<F> {
        if !K::IS_FULL || scene.needs.chain.is_empty() {
            return plain;
        }
        let has_importance = K::Composite::READS_IMPORTANCE;
        let point = ray.point_in_display(t);
        let place = Place { point, gradient: gradients.at, scalars, view: self.view, has_importance };
        self.enhance_at(scene, plain, &place)
    }

    /// Not inlined: it is called from many places, and rarely.
    #[inline(never)]
    fn enhance_at(&self, scene: &Scene<F>, mut sample: Sample<F>, place: &Place<F>) -> Sample<F> {
        for (i, kind) in scene.needs.chain.kinds().enumerate() {
            sample = at(kind, &scene.view.links[i], &self.links[i], sample, place);
        }
        sample
    }

    /// What the links make of a ray at its end. None of today's changes it.
    #[inline(always)]
    pub fn end(&self, front: Accumulated<F>) -> Accumulated<F> {
        front
    }
}

#[inline(always)]
fn start<F: Real>(kind: EnhancerKind, link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
    match kind {
        EnhancerKind::ClipPlane => clip_plane::start(link, view),
        EnhancerKind::Probe => probe::start(link, view),
        EnhancerKind::BandPicker => band_picker::start(link, view),
        EnhancerKind::LayerOpacity => layer_opacity::start(link, view),
    }
}

#[inline(always)]
fn breaks<F: Real>(kind: EnhancerKind, link: &Constants<F>, view: Vec3<F>, ray: &Ray<F>) -> [F; 3] {
    match kind {
        EnhancerKind::ClipPlane => clip_plane::breaks(link, ray),
        EnhancerKind::Probe => probe::breaks(link, view, ray),
        EnhancerKind::BandPicker | EnhancerKind::LayerOpacity => [far(); 3],
    }
}

#[inline(always)]
fn spread<F: Real>(kind: EnhancerKind, link: &Constants<F>) -> F {
    match kind {
        EnhancerKind::Probe => probe::spread(link),
        EnhancerKind::ClipPlane | EnhancerKind::BandPicker | EnhancerKind::LayerOpacity => F::ZERO,
    }
}

#[inline(always)]
fn at<F: Real>(
    kind: EnhancerKind,
    link: &Constants<F>,
    state: &LinkState<F>,
    sample: Sample<F>,
    place: &Place<F>,
) -> Sample<F> {
    match kind {
        EnhancerKind::ClipPlane => clip_plane::at(link, state, sample, place),
        EnhancerKind::Probe => probe::at(link, state, sample, place),
        EnhancerKind::BandPicker => band_picker::at(link, state, sample, place),
        EnhancerKind::LayerOpacity => layer_opacity::at(link, state, sample, place),
    }
}

/// k and τ of a sample, scaled.
#[inline(always)]
pub(super) fn scaled<F: Real>(sample: Sample<F>, factor: F) -> Sample<F> {
    Sample { k: sample.k.map(|k| k * factor), ..sample }
}

/// x, y, z of a vector of constants.
#[inline(always)]
pub(super) fn xyz<F: Real>(vector: &[F; 4]) -> Vec3<F> {
    Vec3([vector[0], vector[1], vector[2]])
}
