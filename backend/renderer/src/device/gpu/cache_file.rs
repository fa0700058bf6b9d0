//! The file that keeps a driver's compiled kernels from one run to the next.
//!
//! All numbers are little-endian: 8 bytes of magic, version (u32), CRC-32 of all that follows (u32), length of the owner
//! (u32), the owner in UTF-8, and the driver's bytes to the end. The owner names adapter and driver: what another has
//! written, or an older driver, is not read. The checksum stands in front because a driver believes what it is given.

use bricks::temporary::temporary_in;
use std::ffi::OsString;
use std::fs::{self, DirBuilder};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const MAGIC: &[u8; 8] = b"LLKERNEL";
const VERSION: u32 = 1;
const VERSION_AT: usize = MAGIC.len();
const CHECKSUM_AT: usize = VERSION_AT + size_of::<u32>();
const OWNER_BYTES_AT: usize = CHECKSUM_AT + size_of::<u32>();
const OWNER_AT: usize = OWNER_BYTES_AT + size_of::<u32>();

/// A driver never forgets a kernel that it was given, nor what earlier versions of this program composed: a file
/// beyond this size is dropped, and started again.
const MOST_BYTES: u64 = 64 << 20;

/// Where one driver's kernels are kept.
#[derive(Debug)]
pub(super) struct CacheFile {
    path: PathBuf,
    owner: String,
}

/// The user's folder of compiled kernels, by environment variables; None if there is none, or LIGHTLOOM_NO_CACHE is
/// set to anything but 0.
pub(super) fn folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    if set("LIGHTLOOM_NO_CACHE").is_some_and(|value| value != "0") {
        return None;
    }
    // The XDG rules: a path that is not absolute counts as none.
    let absolute = |name: &str| set(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let caches = absolute("XDG_CACHE_HOME").or_else(|| Some(absolute("HOME")?.join(".cache")))?;
    Some(caches.join("lightloom").join("pipelines"))
}

impl CacheFile {
    /// The file `name` of `folder`; neither need be there.
    pub(super) fn new(folder: &Path, name: &str, owner: String) -> Self {
        Self { path: folder.join(name), owner }
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The driver's bytes.
    ///
    /// # Errors
    /// The file is missing, damaged, or another driver's.
    pub(super) fn read(&self) -> io::Result<Vec<u8>> {
        let found = fs::metadata(&self.path)?;
        if !found.is_file() || found.len() > MOST_BYTES {
            return Err(io::Error::other("it is not a file, or too large"));
        }
        let mut file = fs::read(&self.path)?;
        let start = start_of_blob(&self.owner, &file).map_err(io::Error::other)?;
        Ok(file.split_off(start))
    }

    /// Replaces the driver's bytes: whoever reads sees the old file or the new one. Of two that write at once the
    /// later stays.
    ///
    /// # Errors
    /// The folder cannot be made or written.
    pub(super) fn write(&self, blob: &[u8]) -> io::Result<()> {
        let folder = self.path.parent().expect("a file is named within a folder");
        make_private(folder)?;
        let mut file = temporary_in(folder)?;
        file.write_all(&encode(&self.owner, blob))?;
        file.persist(&self.path)?;
        Ok(())
    }
}

/// Makes a folder and those above it, for the user alone, as the XDG rules ask.
fn make_private(folder: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

fn encode(owner: &str, blob: &[u8]) -> Vec<u8> {
    let owner_bytes = u32::try_from(owner.len()).expect("an adapter's name is short");
    let mut file = Vec::with_capacity(OWNER_AT + owner.len() + blob.len());
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    file.extend([0; size_of::<u32>()]);
    file.extend(owner_bytes.to_le_bytes());
    file.extend(owner.as_bytes());
    file.extend(blob);
    let checksum = crc32fast::hash(&file[OWNER_BYTES_AT..]);
    file[CHECKSUM_AT..OWNER_BYTES_AT].copy_from_slice(&checksum.to_le_bytes());
    file
}

/// Where the driver's bytes begin, in a file that is whole and the owner's; else what is wrong with it.
fn start_of_blob(owner: &str, file: &[u8]) -> Result<usize, &'static str> {
    if file.len() < OWNER_AT || !file.starts_with(MAGIC) {
        return Err("it is not a file of compiled kernels");
    }
    let number = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| file[at + i]));
    if number(VERSION_AT) != VERSION {
        return Err("it is of another version");
    }
    if number(CHECKSUM_AT) != crc32fast::hash(&file[OWNER_BYTES_AT..]) {
        return Err("it is damaged");
    }
    let start = OWNER_AT + owner.len();
    if number(OWNER_BYTES_AT) as usize != owner.len() || file.get(OWNER_AT..start) != Some(owner.as_bytes()) {
        return Err("another driver wrote it");
    }
    Ok(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWNER: &str = "adapter; driver 1";

    fn file_in(folder: &Path) -> CacheFile {
        CacheFile::new(folder, "kernels", OWNER.into())
    }

    #[test]
    fn what_is_kept_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let file = file_in(&folder.path().join("a/b"));
        assert_eq!(file.read().unwrap_err().kind(), io::ErrorKind::NotFound);
        for blob in [&b"compiled"[..], b"", b"compiled anew"] {
            file.write(blob).unwrap();
            assert_eq!(file.read().unwrap(), blob);
        }
        assert_eq!(fs::read_dir(folder.path().join("a/b")).unwrap().count(), 1, "no working file stays");
    }

    #[test]
    fn a_damaged_file_gives_nothing() {
        let whole = encode(OWNER, b"compiled");
        assert!(start_of_blob(OWNER, &whole).is_ok());
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut spoilt = whole.clone();
                spoilt[at] ^= 1 << bit;
                assert!(start_of_blob(OWNER, &spoilt).is_err(), "bit {bit} of byte {at}");
            }
            assert!(start_of_blob(OWNER, &whole[..at]).is_err(), "cut at {at}");
        }
        let longer = [&whole[..], b"!"].concat();
        assert!(start_of_blob(OWNER, &longer).is_err());
    }

    #[test]
    fn a_file_of_another_driver_gives_nothing() {
        for other in ["adapter; driver 2", "adapter; driver", "adapter; driver 10", ""] {
            assert!(start_of_blob(OWNER, &encode(other, b"compiled")).is_err(), "{other}");
        }
    }

    #[test]
    fn two_writers_leave_one_whole_file() {
        let folder = tempfile::tempdir().unwrap();
        let blobs = [vec![1u8; 100_000], vec![2u8; 50_000]];
        file_in(folder.path()).write(&blobs[0]).unwrap();
        std::thread::scope(|scope| {
            for blob in &blobs {
                let file = file_in(folder.path());
                scope.spawn(move || (0..50).for_each(|_| file.write(blob).unwrap()));
            }
            for _ in 0..200 {
                let found = file_in(folder.path()).read().unwrap();
                assert!(blobs.contains(&found), "a part of a file was seen");
            }
        });
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_takes_no_file_is_an_error_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        assert!(file_in(&file.join("pipelines")).write(b"compiled").is_err());
        // A folder where the file ought to be.
        fs::create_dir(folder.path().join("kernels")).unwrap();
        assert!(file_in(folder.path()).write(b"compiled").is_err());
        assert!(file_in(folder.path()).read().is_err());
        // Files that no one may make, not even root.
        #[cfg(target_os = "linux")]
        assert!(file_in(Path::new("/proc/lightloom")).write(b"compiled").is_err());
    }

    #[test]
    fn the_folder_is_the_users() {
        let folder_with = |set: &[(&str, &str)]| {
            folder(|name| set.iter().find(|(n, _)| *n == name).map(|(_, value)| OsString::from(value)))
        };
        let home = ("HOME", "/home/a");
        let kept = |path: &str| Some(PathBuf::from(path));
        assert_eq!(folder_with(&[home]), kept("/home/a/.cache/lightloom/pipelines"));
        assert_eq!(folder_with(&[home, ("XDG_CACHE_HOME", "/c")]), kept("/c/lightloom/pipelines"));
        for ignored in ["", "relative"] {
            assert_eq!(folder_with(&[home, ("XDG_CACHE_HOME", ignored)]), folder_with(&[home]));
        }
        assert_eq!(folder_with(&[]), None);
        assert_eq!(folder_with(&[home, ("LIGHTLOOM_NO_CACHE", "1")]), None);
        for on in ["", "0"] {
            assert!(folder_with(&[home, ("LIGHTLOOM_NO_CACHE", on)]).is_some());
        }
    }
}
