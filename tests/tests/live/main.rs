//! What happens between frames: feedback, loading, disks that fail, and where live views come to rest.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod faulty_disk;
mod feedback;
mod frames;
mod shown;
