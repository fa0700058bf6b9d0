//! What an enhancer does along a ray.

use crate::composite::Sample;
use crate::ray::{Ray, far};
use crate::scene::Constants;
use crate::{Real, vector::Vec3};
use optics::{Enhancer, EnhancerKind};

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
    /// From there to the end of the segment.
    pub reach: Vec3<F>,
    /// Of the scalar there, per finest voxel, display frame.
    pub gradient: Vec3<F>,
    /// The scalars at the segment's ends.
    pub scalars: (F, F),
    /// The direction in which the ray left the eye.
    pub view: Vec3<F>,
    /// Whether the scene accumulates importance.
    pub has_importance: bool,
}

/// An enhancer as the kernel has it: how it packs its constants, and its hooks at the ray's start and at its samples.
pub(super) trait Hooks {
    /// Its constants, as its WGSL module says.
    fn constants(&self) -> Constants<f64>;

    /// What it makes of the ray's direction, for the other hooks.
    #[inline(always)]
    fn start<F: Real>(_: &Constants<F>, _view: Vec3<F>) -> [F; 4] {
        [F::ZERO; 4]
    }

    /// Where its law is not smooth on a straight way; far where there is no such place.
    #[inline(always)]
    fn breaks<F: Real>(_: &Constants<F>, _view: Vec3<F>, _: &Ray<F>) -> [F; 3] {
        [far(); 3]
    }

    /// Whether it changes samples of a stretch without breaks, of which a point and its t are given.
    #[inline(always)]
    fn acts<F: Real>(_: &Constants<F>, _: &LinkState<F>, _: (Vec3<F>, F)) -> bool {
        true
    }

    /// Whether it looks at the gradient around t.
    #[inline(always)]
    fn looks<F: Real>(_: &LinkState<F>, _t: F) -> bool {
        false
    }

    /// What it makes of a sample.
    fn at<F: Real>(
        link: &Constants<F>,
        state: &LinkState<F>,
        sample: Sample<F>,
        place: &Place<F>,
    ) -> Sample<F>;
}

/// The constants of an enhancer, and each hook of the enhancer of a kind, for all in the table.
macro_rules! dispatch {
    ($($name:ident $stem:ident,)+) => {
        /// The constants of an enhancer.
        pub fn constants(enhancer: &Enhancer) -> Constants<f64> {
            match enhancer { $(Enhancer::$name(numbers) => numbers.constants(),)+ }
        }

        #[inline(always)]
        pub(super) fn start<F: Real>(kind: EnhancerKind, link: &Constants<F>, view: Vec3<F>) -> [F; 4] {
            match kind { $(EnhancerKind::$name => optics::$name::start(link, view),)+ }
        }

        #[inline(always)]
        pub(super) fn breaks<F: Real>(
            kind: EnhancerKind,
            link: &Constants<F>,
            view: Vec3<F>,
            ray: &Ray<F>,
        ) -> [F; 3] {
            match kind { $(EnhancerKind::$name => optics::$name::breaks(link, view, ray),)+ }
        }

        #[inline(always)]
        pub(super) fn acts<F: Real>(
            kind: EnhancerKind,
            link: &Constants<F>,
            state: &LinkState<F>,
            at: (Vec3<F>, F),
        ) -> bool {
            match kind { $(EnhancerKind::$name => optics::$name::acts(link, state, at),)+ }
        }

        #[inline(always)]
        pub(super) fn looks<F: Real>(kind: EnhancerKind, state: &LinkState<F>, t: F) -> bool {
            match kind { $(EnhancerKind::$name => optics::$name::looks(state, t),)+ }
        }

        /// All samples in turn; what an enhancer does not look at of a place is not worked out.
        #[inline(always)]
        pub(super) fn at<'a, F: Real, S: 'a>(
            kind: EnhancerKind,
            link: &Constants<F>,
            state: &LinkState<F>,
            samples: impl Iterator<Item = (&'a mut Sample<F>, &'a S)>,
            place: impl Fn(&S) -> Place<F>,
        ) {
            match kind {
                $(EnhancerKind::$name => {
                    for (sample, segment) in samples {
                        *sample = optics::$name::at(link, state, *sample, &place(segment));
                    }
                })+
            }
        }
    };
}
optics::each_enhancer!(dispatch);
