//! Opening a file that a user named.

use std::fs::File;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// Opens a file to read it. A pipe is refused, as opening one waits for somebody to write; so is a device, which may
/// never end.
///
/// # Errors
/// Those of the file system, and something that is no file.
pub fn open_file(path: &Path) -> Result<File> {
    let found = std::fs::metadata(path)?;
    if found.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    match found.is_file() {
        true => File::open(path),
        false => Err(Error::new(ErrorKind::InvalidInput, "it is a pipe or a device, not a file")),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn only_files_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let (pipe, file) = (folder.path().join("pipe"), folder.path().join("file"));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        std::fs::write(&file, "text").unwrap();
        for wrong in [&pipe, Path::new("/dev/zero")] {
            assert!(open_file(wrong).unwrap_err().to_string().contains("not a file"), "{}", wrong.display());
        }
        assert_eq!(open_file(folder.path()).unwrap_err().kind(), ErrorKind::IsADirectory);
        assert_eq!(open_file(&folder.path().join("none")).unwrap_err().kind(), ErrorKind::NotFound);
        open_file(&file).unwrap();
    }
}
