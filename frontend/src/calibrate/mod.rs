//! Calibration: where a tracker is, by points that both it and the display know.
//!
//! | file | what it is |
//! | --- | --- |
//! | `pairs` | from a file of point pairs to pairs |
//! | `expected` | how far the transform may be off where people are |
//! | `summary` | what is told of a registration |

mod expected;
mod pairs;
mod summary;

pub use pairs::read_pairs;
pub use summary::{PairSummary, TrackerSummary};
