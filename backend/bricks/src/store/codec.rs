//! How blocks of codes become bytes in the store.

/// Zstandard's own default: a good compromise.
const ZSTD_LEVEL: i32 = 3;

/// Compression of the bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// Codes as they are.
    None,
    /// LZ4 blocks, lossless; a brick that would grow is kept as it is.
    Lz4,
    /// Zstandard frames, lossless: smaller and slower.
    Zstd,
}

impl Codec {
    /// Its number in files.
    pub(super) fn number(self) -> u8 {
        match self {
            Codec::None => 0,
            Codec::Lz4 => 1,
            Codec::Zstd => 2,
        }
    }

    /// The codec of a number in files.
    pub(super) fn of_number(number: u8) -> Option<Self> {
        [Codec::None, Codec::Lz4, Codec::Zstd].into_iter().find(|codec| codec.number() == number)
    }

    /// Appends a block, perhaps compressed, and returns how long it became: never longer than `plain`; exactly as long
    /// where it is not compressed.
    pub(super) fn pack_into(self, plain: &[u8], out: &mut Vec<u8>) -> usize {
        let packed = match self {
            Codec::None => None,
            Codec::Lz4 => Some(lz4_flex::block::compress(plain)),
            // It fails only where memory does; the block is then kept as it is.
            Codec::Zstd => zstd::bulk::compress(plain, ZSTD_LEVEL).ok(),
        };
        let block = packed.as_deref().filter(|packed| packed.len() < plain.len()).unwrap_or(plain);
        out.extend_from_slice(block);
        block.len()
    }

    /// The inverse of [`Codec::pack_into`] for a block that was `plain` bytes long.
    ///
    /// # Errors
    /// What is wrong with the bytes.
    pub(super) fn unpack(self, bytes: &[u8], plain: usize) -> Result<Vec<u8>, String> {
        if bytes.len() == plain {
            return Ok(bytes.to_vec());
        }
        let mut unpacked = vec![0; plain];
        let length =
            match self {
                Codec::None => return Err(format!("a block has {} bytes instead of {plain}", bytes.len())),
                Codec::Lz4 => lz4_flex::block::decompress_into(bytes, &mut unpacked)
                    .map_err(|cause| cause.to_string())?,
                Codec::Zstd => zstd::bulk::decompress_to_buffer(bytes, &mut unpacked)
                    .map_err(|cause| cause.to_string())?,
            };
        match length == plain {
            true => Ok(unpacked),
            false => Err(format!("a block unpacks to {length} bytes instead of {plain}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise() -> Vec<u8> {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        };
        (0..32768).map(|_| next()).collect()
    }

    #[test]
    fn what_is_packed_unpacks_again() {
        let smooth: Vec<u8> = (0..65536).map(|i| (i / 640) as u8).collect();
        for codec in [Codec::None, Codec::Lz4, Codec::Zstd] {
            for plain in [&smooth, &noise()] {
                let mut packed = vec![1, 2];
                let length = codec.pack_into(plain, &mut packed);
                assert_eq!((packed.len(), length <= plain.len()), (length + 2, true));
                assert_eq!(codec.unpack(&packed[2..], plain.len()).as_ref(), Ok(plain), "{codec:?}");
            }
            assert_eq!(Codec::of_number(codec.number()), Some(codec));
        }
        assert_eq!(Codec::Lz4.pack_into(&noise(), &mut Vec::new()), 32768, "noise does not grow");
    }

    #[test]
    fn damaged_bytes_are_an_error() {
        for codec in [Codec::Lz4, Codec::Zstd] {
            let mut packed = Vec::new();
            codec.pack_into(&[7; 32768], &mut packed);
            assert!(codec.unpack(&packed[..packed.len() / 2], 32768).is_err());
            assert!(codec.unpack(&packed, 65536).is_err());
            assert!(codec.unpack(&[], 32768).is_err());
        }
        assert!(Codec::None.unpack(&[0; 5], 32768).is_err());
    }
}
