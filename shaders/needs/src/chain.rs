//! The chain of enhancers that a scene needs.

use optics::{Enhancer, EnhancerKind, MOST_ENHANCERS};

/// The enhancers of a kernel, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Chain([Option<EnhancerKind>; MOST_ENHANCERS]);

impl Chain {
    /// None.
    pub const EMPTY: Self = Self([None; MOST_ENHANCERS]);

    /// Of a scene; enhancers that do nothing are left out.
    pub fn of(enhancers: &[Enhancer]) -> Self {
        let mut kinds = enhancers.iter().filter(|e| !e.is_neutral()).map(Enhancer::kind);
        Self(std::array::from_fn(|_| kinds.next()))
    }

    /// Of given kinds; those beyond [`MOST_ENHANCERS`] are dropped.
    pub fn of_kinds(kinds: &[EnhancerKind]) -> Self {
        Self(std::array::from_fn(|i| kinds.get(i).copied()))
    }

    /// The links, in order.
    pub fn kinds(&self) -> impl Iterator<Item = EnhancerKind> + '_ {
        self.0.iter().flatten().copied()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0[0].is_none()
    }

    /// Whether a link looks at importance where none is accumulated, too.
    pub fn needs_importance(&self) -> bool {
        self.kinds().any(EnhancerKind::needs_importance)
    }

    /// Whether a link looks at gradients.
    pub fn needs_gradient(&self) -> bool {
        self.kinds().any(EnhancerKind::needs_gradient)
    }
}
