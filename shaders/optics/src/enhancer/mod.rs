//! Enhancers: what changes samples by where they lie and from where they are seen (LFD section 4).
//!
//! An enhancer is told of the ray once, and then of each sample: its extinction-weighted colour k and extinction τ, its
//! importance, its place x, its scalar s and the gradient g of the scalar. It scales k and τ, and so leaves a picture
//! that does not depend on the step. Enhancers are chained: each is told what the one before it made. In all laws below,
//! v is the direction in which the ray left the eye (a unit vector of the display frame, also where refraction bends
//! the ray later), x is in metres of the display frame, lerp(a, b, t) = a + (b − a) t, and smoothstep(x, low, high) =
//! t² (3 − 2 t) with t = clamp((x − low) / (high − low), 0, 1).

mod band_picker;
mod checks;
mod clip_plane;
mod law;
mod layer_opacity;
mod probe;
mod ramp;

pub use law::Law;
pub use ramp::Ramp;

use crate::{OutOfBounds, Trapezoid};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Enhancers in a chain at most.
pub const MOST_ENHANCERS: usize = 8;

/// The table of enhancers, given to a macro: the type of each, and the stem of its WGSL module and of its twin. Whatever
/// must have an entry for each is made from it, so none can be forgotten.
#[macro_export]
macro_rules! each_enhancer {
    ($then:ident) => {
        $then! {
            ClipPlane clip_plane,
            Probe probe,
            BandPicker band_picker,
            LayerOpacity layer_opacity,
        }
    };
}

/// The enum of all enhancers, that of their kinds, and the laws of each.
macro_rules! enhancers {
    ($($name:ident $stem:ident,)+) => {
        $(pub use $stem::$name;)+

        /// One link of the chain.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Enhancer {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $name($name),)+
        }

        /// The kind of an enhancer.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum EnhancerKind {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $name,)+
        }

        impl EnhancerKind {
            /// All there are.
            pub const ALL: &[Self] = &[$(Self::$name),+];

            /// The stem of its WGSL module and of its twin; the names of a module's functions begin with it.
            pub fn stem(self) -> &'static str {
                match self { $(Self::$name => stringify!($stem),)+ }
            }

            /// Its keys in a scene file, besides `kind` and `carried`.
            pub fn keys(self) -> &'static [&'static str] {
                match self { $(Self::$name => $name::KEYS,)+ }
            }

            /// Whether it looks at gradients.
            pub fn needs_gradient(self) -> bool {
                match self { $(Self::$name => $name::NEEDS_GRADIENT,)+ }
            }

            /// Whether it looks at importance where none is accumulated, too.
            pub fn needs_importance(self) -> bool {
                match self { $(Self::$name => $name::NEEDS_IMPORTANCE,)+ }
            }

            /// Whether it looks at bands of scalars.
            pub fn needs_band(self) -> bool {
                match self { $(Self::$name => $name::NEEDS_BAND,)+ }
            }
        }

        impl Enhancer {
            /// Its kind.
            pub fn kind(&self) -> EnhancerKind {
                match self { $(Self::$name(_) => EnhancerKind::$name,)+ }
            }

            /// See [`Law::check`].
            ///
            /// # Errors
            /// A number is out of its bounds.
            pub fn check(&self) -> Result<(), OutOfBounds> {
                match self { $(Self::$name(found) => found.check(),)+ }
            }

            /// See [`Law::is_neutral`].
            pub fn is_neutral(&self) -> bool {
                match self { $(Self::$name(found) => found.is_neutral(),)+ }
            }

            /// See [`Law::most_factor`].
            pub fn most_factor(&self, corners: &[DVec3; 8]) -> f64 {
                match self { $(Self::$name(found) => found.most_factor(corners),)+ }
            }

            /// See [`Law::may_act_within`].
            pub fn may_act_within(&self, corners: &[DVec3; 8]) -> bool {
                match self { $(Self::$name(found) => found.may_act_within(corners),)+ }
            }

            /// See [`Law::most_importance`].
            pub fn most_importance(&self, lo: f64, hi: f64, before: f64) -> f64 {
                match self { $(Self::$name(found) => found.most_importance(lo, hi, before),)+ }
            }

            /// See [`Law::band_mut`].
            pub fn band_mut(&mut self) -> Option<&mut Trapezoid> {
                match self { $(Self::$name(found) => found.band_mut(),)+ }
            }

            /// See [`Law::place`].
            pub fn place(&mut self, point_in_display: DVec3, axis_in_display: Option<DVec3>) {
                match self { $(Self::$name(found) => found.place(point_in_display, axis_in_display),)+ }
            }
        }
    };
}
each_enhancer!(enhancers);

impl Enhancer {
    /// Its band of scalars, where it has one.
    pub fn band(mut self) -> Option<Trapezoid> {
        self.band_mut().copied()
    }
}

impl EnhancerKind {
    /// Its name in a scene file.
    pub fn name(self) -> String {
        self.stem().replace('_', "-")
    }
}
