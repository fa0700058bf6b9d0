//! A file being written: beside its final place, locked, and removed if the work is abandoned.

use std::ffi::{OsStr, OsString};
use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// How often to open a file again that another process renamed between opening and locking.
const ATTEMPTS: usize = 10;
/// With what is put around them, longer names exceed the 255 bytes of most file systems.
const LONGEST_NAME_BYTES: usize = 240;

/// `.NAME.part` in the folder of NAME. One process writes it at a time; what a killed process left there is taken over.
pub struct WorkingFile {
    path: PathBuf,
    is_renamed: bool,
    /// Keeps the lock until the file is renamed or removed.
    _lock: File,
}

impl WorkingFile {
    /// Starts the file for `target`, empty.
    ///
    /// # Errors
    /// Those of the file system, and another process that writes it.
    pub fn create(target: &Path) -> io::Result<(Self, File)> {
        if target.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        let path =
            target.with_file_name(working_name(target.file_name().ok_or(io::ErrorKind::InvalidInput)?));
        for _ in 0..ATTEMPTS {
            if std::fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
                let what = format!("{} is in the way, and is not a file", path.display());
                return Err(io::Error::new(io::ErrorKind::AlreadyExists, what));
            }
            let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path)?;
            lock(&file)?;
            if is_at(&file, &path) {
                file.set_len(0)?;
                let working = Self { path, is_renamed: false, _lock: file.try_clone()? };
                return Ok((working, file));
            }
        }
        Err(io::ErrorKind::ResourceBusy.into())
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete file its name; what had it before is replaced.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn rename(mut self, target: &Path) -> io::Result<()> {
        std::fs::rename(&self.path, target)?;
        self.is_renamed = true;
        Ok(())
    }
}

impl Drop for WorkingFile {
    fn drop(&mut self) {
        if !self.is_renamed {
            // What is left is taken over by the next program that writes there.
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// `.NAME.part`, or something shorter where that is too long for a file system.
fn working_name(name: &OsStr) -> OsString {
    let mut working = OsString::from(".");
    match name.len() > LONGEST_NAME_BYTES {
        true => working.push(format!("{:08x}", crc32fast::hash(name.as_encoded_bytes()))),
        false => working.push(name),
    }
    working.push(".part");
    working
}

/// Takes a file for this process. On a file system without locks, other processes are not kept from it.
fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            let what = "another program is writing it: wait until it is done, or choose another name";
            Err(io::Error::new(io::ErrorKind::ResourceBusy, what))
        }
        Err(TryLockError::Error(error)) => {
            tracing::warn!(%error, "files cannot be locked here: make sure that no other program writes the same store");
            Ok(())
        }
    }
}

/// Whether a path still leads to an open file: another process may have given it its name meanwhile.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place =
        |metadata: io::Result<std::fs::Metadata>| metadata.ok().map(|found| (found.dev(), found.ino()));
    place(file.metadata()).is_some_and(|open| Some(open) == place(std::fs::symlink_metadata(path)))
}

/// An open file cannot be renamed here, so it is where it was.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn two_writers_do_not_mix() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.lloom");
        let (working, mut file) = WorkingFile::create(&target).unwrap();
        file.write_all(b"one").unwrap();
        let busy = WorkingFile::create(&target).map(|_| ()).unwrap_err();
        assert!(busy.to_string().contains("another program"), "{busy}");
        drop((working, file));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "given up, nothing stays");
    }

    #[test]
    fn what_a_killed_writer_left_is_taken_over() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.lloom");
        std::fs::write(folder.path().join(".a.lloom.part"), "left over").unwrap();
        let (working, mut file) = WorkingFile::create(&target).unwrap();
        file.write_all(b"two").unwrap();
        working.rename(&target).unwrap();
        assert_eq!(std::fs::read(&target).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
