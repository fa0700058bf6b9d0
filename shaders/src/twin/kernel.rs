//! Which modules a twin is made of.

use super::composite::Composite;
use super::shade::Shade;
use std::marker::PhantomData;

/// The slots of a twin that are filled when it is compiled. A kernel is composed for every scene; a twin is compiled
/// once, so rare features are behind branches, and twins with such branches are separate from those without.
pub trait Kernel {
    /// The shading slot.
    type Shade: Shade;
    /// The compositing slot.
    type Composite: Composite;
    /// Whether it looks for levels, materials, detail, enhancers and refraction.
    const IS_FULL: bool;
    /// Whether it looks for nodes that blend into their parents.
    const BLENDS: bool;
}

/// Shading and compositing alone.
pub struct Lean<S, C>(PhantomData<(S, C)>);

/// The same with nodes that blend into their parents.
pub struct Blended<S, C>(PhantomData<(S, C)>);

/// Everything.
pub struct Full<S, C>(PhantomData<(S, C)>);

impl<S: Shade, C: Composite> Kernel for Lean<S, C> {
    type Shade = S;
    type Composite = C;
    const IS_FULL: bool = false;
    const BLENDS: bool = false;
}

impl<S: Shade, C: Composite> Kernel for Blended<S, C> {
    type Shade = S;
    type Composite = C;
    const IS_FULL: bool = false;
    const BLENDS: bool = true;
}

impl<S: Shade, C: Composite> Kernel for Full<S, C> {
    type Shade = S;
    type Composite = C;
    const IS_FULL: bool = true;
    const BLENDS: bool = true;
}
