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
    /// The same volume, finer and coarser.
    Levels,
}

/// The number of the one to read, from 0; `count` is how many the file's header claims.
///
/// # Errors
/// Several are there and none is chosen, or the chosen one is not there: a sentence that says how many there are.
pub(super) fn choose(path: &Path, of: Several, count: i64, chosen: Option<u32>) -> Result<u32, VolumeError> {
    let (one, several) = match of {
        Several::Channels => ("channel", "channels"),
        Several::Times => ("point in time", "points in time"),
        Several::Levels => ("level", "levels"),
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

/// Refuses a choice among things of which there is one, unless it is that one.
pub(super) fn only_one(path: &Path, of: Several, chosen: Option<u32>) -> Result<(), VolumeError> {
    choose(path, of, 1, chosen).map(|_| ())
}

/// Refuses a choice of series where there is none to choose, unless it is the first one's number.
pub(super) fn no_series(path: &Path, chosen: Option<&str>) -> Result<(), VolumeError> {
    match chosen.map(str::trim) {
        None | Some("1") => Ok(()),
        Some(series) => {
            let what = format!("it holds one volume, and no series {series:?} among several: choose none");
            Err(VolumeError::unsupported(path, what))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_only_one_may_be_chosen_by_its_number() {
        let path = Path::new("a.nii");
        for of in [Several::Channels, Several::Times, Several::Levels] {
            assert!(only_one(path, of, None).is_ok() && only_one(path, of, Some(0)).is_ok());
            assert!(only_one(path, of, Some(3)).unwrap_err().to_string().contains("not a number 3"));
        }
        assert!(no_series(path, None).is_ok() && no_series(path, Some("1")).is_ok());
        assert!(no_series(path, Some("2")).unwrap_err().to_string().contains("no series \"2\""));
    }
}
