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
//! in closed form on a span, and only colour is integrated numerically. Where a chain of enhancers acts, depth depends
//! on place and gradient too: such a span is cut at every place where a law of the chain is not smooth, and integrated as a
//! differential equation. Where a refraction index bends light, t is the length of the bent path, which is laid as chords;
//! enhancers still know the direction in which the ray left the eye, and the light sees the direction of the chord.
//!
//! A voxel of a coarse level stands for many. Where its standard deviation σ is known, extinction and colour are the means
//! over the scalars within σ of its own, of equal share each; importance, material, refraction index and the bands of
//! enhancers are those of its mean.
//!
//! How errors keep to the tolerance ε, of which [`Radiance::error_estimate`] is the sum:
//!
//! | what | its error |
//! | --- | --- |
//! | colour of a span | ε/2 per unit of the span's opacity, by Gauss–Kronrod's estimate |
//! | a span with a rise or a chain | ε/4 per unit of light exchanged on each step, by halving the step |
//! | the rest of an opaque ray | ε/10, bounded |
//! | a bent path | by laying it twice: see `refraction::bent_light` |
//! | cubics fitted to a field that is none | 1e-10 of the domain; not in the estimate |
//!
//! | file | what it is |
//! | --- | --- |
//! | `ray` | the ray, and a straight line through the volume |
//! | `cubic`, `fit` | a cubic of one variable in Bernstein form; cubics fitted to a function |
//! | `field` | what a field of data values must answer |
//! | `cut`, `cell`, `cells`, `stored` | the field of a brick source, on the ideal cut or a given one |
//! | `corners`, `level`, `ladder` | its samples blended with those of the two nodes above |
//! | `analytic` | the field of a closed formula, for tests |
//! | `band`, `medium`, `slopes`, `shading`, `span` | the optical model, made ready |
//! | `enhancer`, `enhanced` | a chain of enhancers told of one ray, and a span on which it acts or whose values stand for a spread |
//! | `setting`, `course`, `passage` | what rays of a frame, a straight way and a piece have of it |
//! | `quadrature`, `rise`, `accumulator` | the integration |
//! | `refraction_index`, `refraction` | bent ways, and the light along them |
//! | `segmentation` | the published, step-dependent compositing over given segments |
//! | `tracer` | one call per ray |
//! | `errors` | how far pictures are from the truth |
//! | `finish` | a projector's codes for a picture, stage by stage |

mod accumulator;
#[cfg(test)]
mod analytic;
mod band;
mod cell;
mod cells;
mod corners;
mod course;
mod cubic;
mod cut;
mod enhanced;
mod enhancer;
mod errors;
mod field;
mod finish;
mod fit;
mod ladder;
#[cfg(test)]
mod laws;
#[cfg(test)]
mod laws_enhancers;
#[cfg(test)]
mod laws_levels;
#[cfg(test)]
mod laws_refraction;
mod level;
mod medium;
mod passage;
mod quadrature;
mod radiance;
mod ray;
mod refraction;
mod refraction_index;
mod rise;
mod segmentation;
mod setting;
mod shading;
mod slopes;
mod span;
mod stored;
#[cfg(test)]
mod test_scene;
mod tracer;

pub use accumulator::Integrator;
#[cfg(test)]
use analytic::AnalyticField;
pub use cubic::Cubic;
pub use errors::Errors;
pub use field::{Field, Levels, Piece, Visitor};
pub use finish::{Filter, FinishTruth};
pub use radiance::Radiance;
pub use ray::{Line, Ray};
pub use segmentation::{Segmentation, SegmentationError};
pub use stored::StoredField;
pub use tracer::{Reference, ReferenceError, Tracer};
