//! Whether two paths lead to one file.

use std::path::Path;

/// Whether both files are there and are the same.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
