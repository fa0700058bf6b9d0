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
    /// The twin of stretches of a ray that no enhancer changes.
    type Plain: Kernel;
}

/// Shading and compositing alone.
pub struct Lean<S, C>(PhantomData<(S, C)>);

/// The same with nodes that blend into their parents.
pub struct Blended<S, C>(PhantomData<(S, C)>);

/// The same with enhancers.
pub struct Enhanced<S, C>(PhantomData<(S, C)>);

/// Everything.
pub struct Full<S, C>(PhantomData<(S, C)>);

/// What each twin looks for, and what it is made of.
macro_rules! kernels {
    ($($name:ident: full $full:literal, blends $blends:literal, enhances $enhances:literal, plain $plain:ident;)+) => {$(
        impl<S, C: Composite> Features for $name<S, C> {
            const IS_FULL: bool = $full;
            const BLENDS: bool = $blends;
            const ENHANCES: bool = $enhances;
            const READS_IMPORTANCE: bool = C::READS_IMPORTANCE;
        }

        impl<S: Shade, C: Composite> Kernel for $name<S, C> {
            type Shade = S;
            type Composite = C;
            type Plain = $plain<S, C>;
        }
    )+};
}
kernels! {
    Lean: full false, blends false, enhances false, plain Lean;
    Blended: full false, blends true, enhances false, plain Blended;
    Enhanced: full false, blends true, enhances true, plain Blended;
    Full: full true, blends true, enhances true, plain Full;
}
