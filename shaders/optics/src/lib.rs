//! The optical model of a scene: what a scalar value looks like.

mod bounds;
mod curve;
mod debug_view;
mod enhancer;
mod light;
mod material;
mod model;
mod quality;
mod trapezoid;

pub use bounds::OutOfBounds;
pub use curve::{Curve, CurveError, CurveValue};
pub use debug_view::{DebugView, heat_ramps};
pub use enhancer::*;
pub use light::{Detail, Light};
pub use material::Material;
pub use model::{ExtinctionUnit, Mimda, MimdaForm, Optics, OpticsError};
pub use quality::Quality;
pub use trapezoid::{Trapezoid, TrapezoidError};
