//! From a tracker's raw poses to where a tool is, and where it will be. Pure: no clock, no file, no network.
//!
//! | module | what it is |
//! | --- | --- |
//! | `pose`, `rigid`, `turn` | where a body is, transforms between frames, and rotations as vectors |
//! | `registration` | from point pairs to the transform between the tracker's frame and the display's |
//! | `one_euro`, `filter` | what takes the jitter from a still tool and leaves a fast one alone |
//! | `line`, `predictor` | where the tool will be when a frame is seen |
//! | `presence` | how much of a tool is there while its target comes and goes |
//! | `track` | all of these for one tool: samples in, the tool of a frame out |

mod filter;
#[cfg(test)]
mod fixed_seed;
mod line;
#[cfg(test)]
mod noise;
mod one_euro;
mod pose;
mod predictor;
mod presence;
mod registration;
mod rigid;
mod track;
mod turn;

pub use filter::PoseFilter;
pub use one_euro::OneEuro;
pub use pose::{FARTHEST_M, Pose};
pub use predictor::PosePredictor;
pub use registration::{Frame, Handedness, Outlier, PointPair, Registration, RegistrationError, register};
pub use rigid::RigidTransform;
pub use track::{SampleCounts, ToolTrack, TrackSettings, Tracked};
