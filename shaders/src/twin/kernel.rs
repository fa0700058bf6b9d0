//! Which modules a twin is made of.

use super::composite::Composite;
use super::features::Features;
use super::shade::Shade;
use std::marker::PhantomData;

/// The slots of a twin that are filled when it is compiled. A kernel is composed for every scene; a twin is compiled
/// once, so rare features are behind branches, and twins with such branches are separate from those without.
pub trait Kernel: Features {
    /// The shading slot.
    type Shade: Shade;
    /// The compositing slot.
    type Composite: Composite;
}

/// Shading and compositing alone.
pub struct Lean<S, C>(PhantomData<(S, C)>);

/// The same with nodes that blend into their parents.
pub struct Blended<S, C>(PhantomData<(S, C)>);

/// Everything.
pub struct Full<S, C>(PhantomData<(S, C)>);

impl<S, C: Composite> Features for Lean<S, C> {
    const IS_FULL: bool = false;
    const BLENDS: bool = false;
    const READS_IMPORTANCE: bool = C::READS_IMPORTANCE;
}

impl<S: Shade, C: Composite> Kernel for Lean<S, C> {
    type Shade = S;
    type Composite = C;
}

impl<S, C: Composite> Features for Blended<S, C> {
    const IS_FULL: bool = false;
    const BLENDS: bool = true;
    const READS_IMPORTANCE: bool = C::READS_IMPORTANCE;
}

impl<S: Shade, C: Composite> Kernel for Blended<S, C> {
    type Shade = S;
    type Composite = C;
}

impl<S, C: Composite> Features for Full<S, C> {
    const IS_FULL: bool = true;
    const BLENDS: bool = true;
    const READS_IMPORTANCE: bool = C::READS_IMPORTANCE;
}

impl<S: Shade, C: Composite> Kernel for Full<S, C> {
    type Shade = S;
    type Composite = C;
}
