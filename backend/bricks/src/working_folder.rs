//! A folder being written: beside its final place, and removed with all in it if the work is abandoned.

use crate::working_file::WorkingFile;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// `.NAME.folder` beside NAME, which the working file of the same name keeps for one process; what a killed process left
/// there is removed first.
pub struct WorkingFolder {
    path: PathBuf,
    is_renamed: bool,
    // Dropped last: until the folder is gone nobody else may have its name.
    _guard: WorkingFile,
}

impl WorkingFolder {
    /// Makes the folder for `target`, empty.
    ///
    /// # Errors
    /// Those of the file system, and another process that is at work on it.
    pub fn create(target: &Path) -> io::Result<Self> {
        let (guard, _) = WorkingFile::create(target)?;
        let path = guard.path().with_extension("folder");
        match fs::remove_dir_all(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            Ok(()) | Err(_) => fs::create_dir(&path)?,
        }
        Ok(Self { path, is_renamed: false, _guard: guard })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete folder its name.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn rename(mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.is_renamed = true;
        Ok(())
    }
}

impl Drop for WorkingFolder {
    fn drop(&mut self) {
        if !self.is_renamed {
            // What is left is removed by the next program that writes there.
            let _ = fs::remove_dir_all(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_whole_or_gone() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.zarr");
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let working = WorkingFolder::create(&target).unwrap();
        fs::write(working.path().join("chunk"), "one").unwrap();
        assert!(
            WorkingFolder::create(&target).map(|_| ()).unwrap_err().to_string().contains("another program")
        );
        drop(working);
        assert_eq!(count(), 0, "given up, nothing stays");
        // As a killed program leaves it.
        fs::create_dir_all(folder.path().join(".a.zarr.folder/c/0")).unwrap();
        fs::write(folder.path().join(".a.zarr.part"), "").unwrap();
        let working = WorkingFolder::create(&target).unwrap();
        assert_eq!(fs::read_dir(working.path()).unwrap().count(), 0);
        working.rename(&target).unwrap();
        assert!(target.is_dir() && count() == 1);
    }
}
