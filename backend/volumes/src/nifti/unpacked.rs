//! The bytes of a NIfTI file, packed with gzip or not.

use super::super::gzip::Gzip;
use bricks::volume::{VolumeError, open_file};
use std::io::{BufReader, Read};
use std::path::Path;

const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// The file's bytes, unpacked.
pub(super) fn reader(path: &Path) -> Result<Box<dyn Read>, VolumeError> {
    let is_gzip = is_gzip(path)?;
    let file = open_file(path).map_err(VolumeError::open(path))?;
    Ok(if is_gzip { Box::new(Gzip::new(BufReader::new(file))) } else { Box::new(file) })
}

/// Whether a file is packed, by its first bytes.
pub(super) fn is_gzip(path: &Path) -> Result<bool, VolumeError> {
    let mut start = [0; 2];
    let mut file = open_file(path).map_err(VolumeError::open(path))?;
    Ok(file.read_exact(&mut start).is_ok() && start == GZIP_MAGIC)
}
