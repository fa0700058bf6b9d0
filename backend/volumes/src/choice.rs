//! The one volume that a user chose among those of a file.

use bricks::volume::VolumeError;
use std::path::Path;

/// What a file can hold several of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Several {
    /// Numbers at each voxel.
    Channels,
    /// Volumes one after the other.
    Times,
}

/// The number of the one to read, from 0; `count` is how many the file's header claims.
///
/// # Errors
/// Several are there and none is chosen, or the chosen one is not there: a sentence that says how many there are.
pub(super) fn choose(path: &Path, of: Several, count: i64, chosen: Option<u32>) -> Result<u32, VolumeError> {
    let (one, several) = match of {
        Several::Channels => ("channel", "channels"),
        Several::Times => ("point in time", "points in time"),
    };
    let count = count.max(1);
    match chosen {
        Some(index) if i64::from(index) < count => Ok(index),
        None if count == 1 => Ok(0),
        Some(index) if count == 1 => Err(VolumeError::unsupported(
            path,
            format!("it has one {one}, number 0, and not a number {index}: choose 0 or none"),
        )),
        Some(index) => Err(VolumeError::unsupported(
            path,
            format!("it has {count} {several}, and not a number {index}: choose from 0 to {}", count - 1),
        )),
        None => Err(VolumeError::unsupported(
            path,
            format!("it has {count} {several}: choose one of them, from 0 to {}", count - 1),
        )),
    }
}
