//! The optical model of a scene: what a scalar value looks like.

mod curve;
mod light;
mod model;
mod quality;

pub use curve::{Curve, CurveError, CurveValue};
pub use light::Light;
pub use model::{ExtinctionUnit, Mimda, MimdaForm, Optics, OpticsError};
pub use quality::Quality;
