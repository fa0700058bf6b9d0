//! Files that appear whole or not at all.

use super::OutputError;
use bricks::links::followed;
use bricks::temporary::temporary_in;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes `path` through a temporary file beside it: whoever looks sees the old file or the new one, never a part. A link stays,
/// and what it leads to is written.
pub fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let path = &followed(path).map_err(|e| OutputError::write(path, e))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = temporary_in(folder).map_err(|e| OutputError::write(path, e))?;
    let mut writer = BufWriter::new(file.as_file_mut());
    fill(&mut writer)?;
    writer.flush().map_err(|e| OutputError::write(path, e))?;
    drop(writer);
    file.persist(path).map_err(|e| OutputError::write(path, e.error))?;
    Ok(())
}

/// Makes `folder` and tries a file in it, so that a run finds out before it has rendered for an hour.
pub fn can_write_into(folder: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(folder).map_err(|e| OutputError::write(folder, e))?;
    let mut file = temporary_in(folder).map_err(|e| OutputError::write(folder, e))?;
    file.write_all(b"lightloom").map_err(|e| OutputError::write(folder, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "old").unwrap();
        let result = write_atomically(&path, |w| {
            w.write_all(b"ne").unwrap();
            Err(OutputError::encode(&path, "stopped"))
        });
        assert!(result.is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_leads_to_what_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let [link, there] = ["link.txt", "there.txt"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink("there.txt", &link).unwrap();
        // Whether anything is there or not.
        for text in ["new", "newer"] {
            write_atomically(&link, |w| {
                w.write_all(text.as_bytes()).unwrap();
                Ok(())
            })
            .unwrap();
            assert!(link.is_symlink() && std::fs::read_to_string(&there).unwrap() == text);
        }
    }

    #[test]
    fn a_folder_under_a_file_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let error = can_write_into(&file.join("out")).unwrap_err().to_string();
        assert!(error.contains("out"), "{error}");
    }
}
