//! Pictures from capacity-constrained points: how STE (Frey et al. 2014, section 5.1) casts and reconstructs them, to be
//! compared with the lattices of `renderer::refine`.
//!
//! | file | what it is |
//! | --- | --- |
//! | `torus` | places and distances on a rectangle whose opposite edges meet |
//! | `near` | which sites are near a place |
//! | `capacity` | sites that serve equally many points, each near its own (Balzer et al. 2009) |
//! | `pattern` | a set of sites, its bytes, and how even it is |
//! | `samples` | a pattern scaled into the tiles of a level, as rays of a picture |
//! | `level` | a level's picture, reconstructed from its rays by a Gaussian (STE eq. 4) |
//! | `schedule` | tiles in their order, what each costs, and pictures in which two levels meet |

mod capacity;
mod level;
mod near;
mod pattern;
mod samples;
mod schedule;
mod torus;

pub use capacity::{Capacity, Wish};
pub use level::{Kernel, Level, Reconstructed};
pub use pattern::Pattern;
pub use samples::Samples;
pub use schedule::{Mix, Schedule};
pub use torus::{Place, Torus};
