//! From a tracker's raw poses to where a tool is, and where it will be. Pure: no clock, no file, no network.
//!
//! | module | what it is |
//! | --- | --- |
//! | `pose`, `rigid` | where a body is, and transforms between frames |
//! | `registration` | from point pairs to the transform between the tracker's frame and the display's |

#[cfg(test)]
mod fixed_seed;
#[cfg(test)]
mod noise;
mod pose;
mod registration;
mod rigid;

pub use pose::Pose;
pub use registration::{Frame, Handedness, Outlier, PointPair, Registration, RegistrationError, register};
pub use rigid::RigidTransform;
