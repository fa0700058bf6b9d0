//! Reads a file whole.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// Longer files are mistakes, bytes: what people and their programs write for a display or a scene is far shorter.
const MOST: u64 = 64 << 20;

/// The text of a file.
///
/// # Errors
/// Those of the file system; it is no regular file, too long, or no UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    let no_text = |_| Error::new(ErrorKind::InvalidData, "stream did not contain valid UTF-8");
    String::from_utf8(read_bytes(path)?).map_err(no_text)
}

/// The bytes of a file.
///
/// # Errors
/// Those of the file system; it is no regular file, or too long.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    // Before it is opened: a pipe would wait for somebody who writes.
    if !std::fs::metadata(path)?.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > MOST {
        true => Err(Error::new(ErrorKind::FileTooLarge, format!("it is longer than {} MiB", MOST >> 20))),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_and_what_is_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        std::fs::write(&path, "η = 1\n").unwrap();
        assert_eq!(read_text(&path).unwrap(), "η = 1\n");
        let refused = |path: &Path| read_text(path).unwrap_err().to_string();
        assert_eq!(refused(folder.path()), "it is no regular file");
        File::create(&path).unwrap().set_len(MOST + 1).unwrap();
        assert_eq!(refused(&path), "it is longer than 64 MiB");
        #[cfg(unix)]
        {
            let link = folder.path().join("zero.toml");
            std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
            assert_eq!(refused(&link), "it is no regular file");
        }
    }
}
