//! How far pictures are from the truth, and what that costs: settings are swept, timed and compared.
//!
//! | file | what it is |
//! | --- | --- |
//! | `setting`, `sweep` | one way to draw, and those that are tried |
//! | `projectors` | which projectors' pictures are compared |
//! | `truth` | their pixels by the reference |
//! | `bench` | the device that draws, timed |
//! | `study`, `run` | what is studied; all of it, from a scene to what was found |
//! | `pareto` | which settings no other one beats |
//! | `watch`, `supervise` | how a study is stopped, and reports how far it is |

mod bench;
mod error;
mod pareto;
mod projectors;
mod run;
mod setting;
mod study;
mod supervise;
mod sweep;
mod truth;
mod watch;

pub use bench::Measured;
pub use error::AccuracyError;
pub use pareto::{BEATEN_BY, Score, beaten_by, front};
pub use projectors::{check_projectors, two_projectors};
pub use run::Outcome;
pub use setting::{Family, Setting, Trial, filter_name, levels_of, small};
pub use study::Study;
pub use supervise::supervised;
pub use sweep::{Offer, around_default, product};
pub use truth::TruthSummary;
pub use watch::Watch;
