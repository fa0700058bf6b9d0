//! Whether two paths lead to one file.

use std::path::Path;

/// Whether both files are there and are the same.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}

/// What all names of a file share, links of either kind among them; None where there is no file.
#[cfg(unix)]
pub(crate) fn identity(path: &Path) -> Option<impl PartialEq> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|file| (file.dev(), file.ino()))
}

/// The same where no numbers of files are known: hard links count as files of their own.
#[cfg(not(unix))]
pub(crate) fn identity(path: &Path) -> Option<impl PartialEq> {
    path.canonicalize().ok()
}
