//! The f64 truth: adaptive quadrature of the continuous optical model.
//!
//! Along a ray x(t) = O + t·v (t in metres of the display frame, v a unit vector) with extinction τ, emission e and
//! importance ι, and ι_max the running maximum of ι, starting at 0:
//!
//! ```text
//! dC = −C dP + (1 − A) e dt        dP = γ dι_max                     (paper, in the limit of infinitely many steps)
//! dA = −A dP + (1 − A) τ dt        dP = γ dι_max / (1 − γ ι_max)     (consistent)
//! ```
//!
//! γ = 0 is plain emission and absorption. A *piece* is a part of the ray on which the data value is one cubic of t; a
//! *span* is a part of a piece on which all curves of the optics are linear in the scalar. So optical depth is known
//! in closed form on a span, and only colour is integrated numerically.
//!
//! | file | what it is |
//! | --- | --- |
//! | `ray` | the ray, and a straight line through the volume |
//! | `cubic` | a cubic of one variable in Bernstein form |
//! | `field` | what a field of data values must answer |
//! | `cut`, `cell`, `stored` | the field of a brick source, on the ideal cut |
//! | `analytic` | the field of a closed formula |
//! | `medium`, `shading`, `span` | the optical model, made ready |
//! | `quadrature`, `rise`, `accumulator` | the integration |
//! | `segmentation` | the published, step-dependent compositing over given segments |
//! | `tracer` | one call per ray |
//! | `errors` | how far pictures are from the truth |

mod accumulator;
mod analytic;
mod cell;
mod cubic;
mod cut;
mod errors;
mod field;
#[cfg(test)]
mod laws;
mod medium;
mod quadrature;
mod radiance;
mod ray;
mod rise;
mod segmentation;
mod shading;
mod span;
mod stored;
#[cfg(test)]
mod test_scene;
mod tracer;

pub use accumulator::Integrator;
pub use analytic::AnalyticField;
pub use cubic::Cubic;
pub use errors::Errors;
pub use field::{Field, Piece, Visitor};
pub use radiance::Radiance;
pub use ray::{Line, Ray};
pub use segmentation::{Segmentation, SegmentationError};
pub use stored::StoredField;
pub use tracer::{Reference, ReferenceError, Tracer};
