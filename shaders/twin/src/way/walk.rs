//! A straight ray on its way from leaf to leaf.

use crate::composite::Accumulated;
use crate::traverse::Exit;
use crate::{Cast, Casting, Real, ray::Ray};
use layout::{NO_NODE, NO_SLOT, NodeRecord};

/// What a stretch has led to.
pub(super) struct Marched<F> {
    pub(super) front: Accumulated<F>,
    pub(super) samples: u32,
    /// Whether nothing that follows can be seen.
    pub(super) is_done: bool,
}

/// A straight ray on its way.
pub(super) struct Walk<'a, F> {
    pub(super) ray: &'a Ray<F>,
    /// Where it enters the leaf that it is in.
    pub(super) t: F,
    t_end: F,
    /// That leaf, or [`NO_NODE`] at its end.
    pub(super) at: u32,
    pub(super) front: Accumulated<F>,
    pub(super) cast: Cast<F>,
    /// Whether nothing that follows can be seen.
    pub(super) is_done: bool,
}

impl<'a, F: Real> Walk<'a, F> {
    /// A ray where it enters the volume.
    #[inline(always)]
    pub(super) fn begin(casting: &Casting<F>, ray: &'a Ray<F>) -> Self {
        let (t, t_end) = ray.clip_to_volume(casting.scene.dims);
        // Not where a span is not a number.
        let at = if t < t_end { casting.leaf_at(ray.point(t), ray) } else { NO_NODE };
        Self { ray, t, t_end, at, front: Accumulated::NOTHING, cast: Cast::NOTHING, is_done: false }
    }

    /// Where it leaves the leaf that it is in.
    #[inline(always)]
    pub(super) fn exit(&self, casting: &Casting<F>, leaf: &NodeRecord) -> Exit<F> {
        let exit = casting.exit_of(leaf, self.ray);
        Exit { t: exit.t.most(self.t).least(self.t_end), ..exit }
    }

    /// Whether the leaf has samples for it, which it takes note of.
    #[inline(always)]
    pub(super) fn looks(&mut self, casting: &Casting<F>, leaf: &NodeRecord, exit: &Exit<F>) -> bool {
        let looks = leaf.slot != NO_SLOT && exit.t > self.t;
        if looks {
            casting.observer.note(self.at, leaf.deficit);
            self.cast.is_missing |= leaf.deficit > 0.0;
        }
        looks
    }

    /// Adds what a stretch has led to.
    #[inline(always)]
    pub(super) fn add(&mut self, marched: Marched<F>) {
        (self.front, self.is_done) = (marched.front, marched.is_done);
        self.cast.samples += marched.samples;
    }

    /// Goes on from where it leaves the leaf, if there is more to see.
    #[inline(always)]
    pub(super) fn go_on(&mut self, casting: &Casting<F>, leaf: &NodeRecord, exit: &Exit<F>) {
        if self.is_done || exit.t >= self.t_end {
            self.at = NO_NODE;
            return;
        }
        self.t = exit.t;
        self.at = casting.leaf_beyond(leaf, exit.axis, self.ray.point(exit.t), self.ray);
    }

    /// What it brings back.
    #[inline(always)]
    pub(super) fn end(&self) -> Cast<F> {
        self.cast.with_colours(self.front)
    }
}
