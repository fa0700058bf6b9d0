//! What an enhancer does along a ray, or along eight side by side.

use super::place::{Place, Segment};
use crate::composite::Sample;
use crate::ray::{FAR, Line};
use crate::real::Number;
use crate::scene::Constants;
use crate::vector::Vec3;
use optics::{Enhancer, EnhancerKind};

/// An enhancer's state along a ray.
#[derive(Clone, Copy, Debug)]
pub struct LinkState<N> {
    /// What it has made of the ray's direction.
    pub weights: [N; 4],
    /// Where on the ray its law is not smooth; far where there is no such place.
    pub breaks: [N; 3],
}

/// An enhancer as the kernel has it: how it packs its constants, and its hooks at the ray's start and at its samples.
pub(super) trait Hooks {
    /// Its constants, as its WGSL module says.
    fn constants(&self) -> Constants<f64>;

    /// What it makes of the ray's direction, for the other hooks.
    #[inline(always)]
    fn start<N: Number>(_: &Constants<N>, view: Vec3<N>) -> [N; 4] {
        [view.0[0].alike(0.0); 4]
    }

    /// Where its law is not smooth on a straight way; far where there is no such place.
    #[inline(always)]
    fn breaks<N: Number>(_: &Constants<N>, view: Vec3<N>, _: &Line<N>) -> [N; 3] {
        [view.0[0].alike(FAR); 3]
    }

    /// Above 0 if it changes samples of a stretch without breaks, of which a point and its t are given.
    fn acts<N: Number>(_: &Constants<N>, _: &LinkState<N>, at: (Vec3<N>, N)) -> N;

    /// Above 0 if it looks at the gradient around t.
    #[inline(always)]
    fn looks<N: Number>(_: &LinkState<N>, t: N) -> N {
        t.alike(0.0)
    }

    /// What it makes of a sample: the same to the bit of a ray alone and beside others, so whatever the law chooses between is
    /// worked out, and left early only where all agree.
    fn at<N: Number>(
        link: &Constants<N>,
        state: &LinkState<N>,
        sample: Sample<N>,
        place: &Place<N>,
    ) -> Sample<N>;
}

/// The constants of an enhancer, and each hook of the enhancer of a kind, for all in the table.
macro_rules! dispatch {
    ($($name:ident $stem:ident,)+) => {
        /// The constants of an enhancer.
        pub fn constants(enhancer: &Enhancer) -> Constants<f64> {
            match enhancer { $(Enhancer::$name(numbers) => numbers.constants(),)+ }
        }

        #[inline(always)]
        pub(super) fn start<N: Number>(kind: EnhancerKind, link: &Constants<N>, view: Vec3<N>) -> [N; 4] {
            match kind { $(EnhancerKind::$name => optics::$name::start(link, view),)+ }
        }

        #[inline(always)]
        pub(super) fn breaks<N: Number>(
            kind: EnhancerKind,
            link: &Constants<N>,
            view: Vec3<N>,
            line: &Line<N>,
        ) -> [N; 3] {
            match kind { $(EnhancerKind::$name => optics::$name::breaks(link, view, line),)+ }
        }

        #[inline(always)]
        pub(super) fn acts<N: Number>(
            kind: EnhancerKind,
            link: &Constants<N>,
            state: &LinkState<N>,
            at: (Vec3<N>, N),
        ) -> N {
            match kind { $(EnhancerKind::$name => optics::$name::acts(link, state, at),)+ }
        }

        #[inline(always)]
        pub(super) fn looks<N: Number>(kind: EnhancerKind, state: &LinkState<N>, t: N) -> N {
            match kind { $(EnhancerKind::$name => optics::$name::looks(state, t),)+ }
        }

        /// All samples in turn; what an enhancer does not look at of a place is not worked out.
        #[inline(always)]
        pub(super) fn at<N: Number, const COUNT: usize>(
            kind: EnhancerKind,
            link: &Constants<N>,
            state: &LinkState<N>,
            samples: &mut [Sample<N>; COUNT],
            segments: &[Segment<'_, N>; COUNT],
            (view, has_importance): (Vec3<N>, bool),
        ) {
            match kind {
                $(EnhancerKind::$name => {
                    for (sample, segment) in samples.iter_mut().zip(segments) {
                        let place = segment.place(view, has_importance);
                        *sample = optics::$name::at(link, state, *sample, &place);
                    }
                })+
            }
        }
    };
}
optics::each_enhancer!(dispatch);
