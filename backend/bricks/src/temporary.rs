//! Working files beside their final places.

use std::io;
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// A file that deletes itself unless it is given a name; readable like any other file of the user.
///
/// # Errors
/// Those of the file system, without the working file's own path.
pub fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".lightloom-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(without_path)
}

/// The error without the working file's path that `tempfile` appends: the user knows only the final file.
fn without_path(error: io::Error) -> io::Error {
    let text = error.to_string();
    let plain = text.split(" at path \"").next().unwrap_or(&text);
    io::Error::new(error.kind(), plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_tells_of_no_working_file() {
        let folder = tempfile::tempdir().unwrap();
        let error = temporary_in(&folder.path().join("nowhere")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
        assert!(!error.to_string().contains(".part"), "{error}");
    }
}
