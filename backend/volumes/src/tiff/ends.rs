//! Whether packed strips and tiles end as they must: the decoder reads none to its end, where its checksum is.

use super::relabel::Relabelled;
use flate2::bufread::ZlibDecoder;
use rayon::prelude::*;
use std::io::{Read, Result, Seek, SeekFrom};
use tiff::tags::CompressionMethod;

/// Bytes that are read from the file before they are looked at, together: enough for all cores.
const BYTES_AT_ONCE: usize = 16 << 20;
/// What a Zstandard frame starts with, and the bit of the byte after that says that it has a checksum (RFC 8878, 3.1.1).
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
const ZSTD_CHECKSUM: u8 = 4;

/// How a strip or tile is packed, if there may be a checksum at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Checked {
    Zlib,
    Zstd,
}

impl Checked {
    /// For the number of a compression; None where nothing can be checked.
    pub fn of(compression: u16) -> Option<Self> {
        match CompressionMethod::from_u16(compression)? {
            CompressionMethod::Deflate | CompressionMethod::OldDeflate => Some(Self::Zlib),
            CompressionMethod::ZSTD => Some(Self::Zstd),
            _ => None,
        }
    }

    /// Checks strips or tiles at these places, each with its bytes. Of one that unpacks to more than `most_bytes`, which
    /// nobody asks for, the end is not looked at.
    pub fn check(self, file: &mut Relabelled, places: &[(u64, u64)], most_bytes: u64) -> Result<()> {
        let mut batch: Vec<Vec<u8>> = Vec::new();
        for (number, &(offset, bytes)) in places.iter().enumerate() {
            let mut packed = Vec::new();
            file.seek(SeekFrom::Start(offset))?;
            file.take(bytes).read_to_end(&mut packed)?;
            batch.push(packed);
            let is_full = batch.iter().map(Vec::len).sum::<usize>() >= BYTES_AT_ONCE;
            if is_full || number + 1 == places.len() {
                batch.par_iter().try_for_each(|packed| self.check_one(packed, most_bytes))?;
                batch.clear();
            }
        }
        Ok(())
    }

    fn check_one(self, packed: &[u8], most_bytes: u64) -> Result<()> {
        let has_checksum =
            packed.starts_with(&ZSTD_MAGIC) && packed.get(4).is_some_and(|flags| flags & ZSTD_CHECKSUM != 0);
        match self {
            Self::Zlib => read_all(ZlibDecoder::new(packed), most_bytes),
            Self::Zstd if has_checksum => {
                read_all(zstd::Decoder::with_buffer(packed)?.single_frame(), most_bytes)
            }
            Self::Zstd => Ok(()),
        }
    }
}

/// Reads to the end, if that comes soon enough.
fn read_all(unpacked: impl Read, most_bytes: u64) -> Result<()> {
    std::io::copy(&mut unpacked.take(most_bytes.saturating_add(1)), &mut std::io::sink()).map(|_| ())
}
