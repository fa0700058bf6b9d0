//! The files of an array as zarrs asks for them, none larger than can be right.

use bricks::volume::open_file;
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::Arc;
use zarrs::storage::byte_range::{ByteRange, ByteRangeIterator};
use zarrs::storage::{Bytes, MaybeBytesIterator, ReadableStorageTraits, StorageError, StoreKey};

/// A folder whose files are keys.
pub(super) struct Files {
    /// The array's folder.
    pub root: PathBuf,
    /// No read may take more memory.
    pub most_bytes: u64,
}

impl Files {
    /// Where a key is.
    pub fn path(&self, key: &StoreKey) -> PathBuf {
        self.root.join(key.as_str())
    }

    fn open(&self, key: &StoreKey) -> Result<Option<(File, u64)>, StorageError> {
        let failed = |error| StorageError::IOError(Arc::new(error));
        match open_file(&self.path(key)) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(failed(error)),
            Ok(file) => {
                let length = file.metadata().map_err(failed)?.len();
                Ok(Some((file, length)))
            }
        }
    }

    fn read(&self, file: &mut File, length: u64, range: ByteRange) -> Result<Bytes, StorageError> {
        let (start, bytes) = match range {
            ByteRange::FromStart(start, bytes) => (start, bytes.unwrap_or(length.saturating_sub(start))),
            ByteRange::Suffix(bytes) => (length.saturating_sub(bytes), bytes),
        };
        if start.checked_add(bytes).is_none_or(|end| end > length) {
            let what = format!("its bytes {start} to {start} + {bytes} are wanted, and it has {length}");
            return Err(StorageError::Other(what));
        }
        if bytes > self.most_bytes {
            let what = format!("it has {bytes} bytes, and {} can be right at most", self.most_bytes);
            return Err(StorageError::Other(what));
        }
        let mut read = vec![0; bytes as usize];
        let failed = |error| StorageError::IOError(Arc::new(error));
        file.seek(SeekFrom::Start(start)).map_err(failed)?;
        file.read_exact(&mut read).map_err(failed)?;
        Ok(read.into())
    }
}

impl ReadableStorageTraits for Files {
    fn get_partial_many<'a>(
        &'a self,
        key: &StoreKey,
        ranges: ByteRangeIterator<'a>,
    ) -> Result<MaybeBytesIterator<'a>, StorageError> {
        let Some((mut file, length)) = self.open(key)? else { return Ok(None) };
        Ok(Some(Box::new(ranges.map(move |range| self.read(&mut file, length, range)))))
    }

    fn size_key(&self, key: &StoreKey) -> Result<Option<u64>, StorageError> {
        Ok(self.open(key)?.map(|(_, length)| length))
    }

    fn supports_get_partial(&self) -> bool {
        true
    }
}
