//! How a brick's codes become bytes in the store.

use super::{BRICK_VOXELS, CodeBits, Codes};

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
    /// Bytes of the codes, little-endian, perhaps compressed. Never longer than [`CodeBits::brick_bytes`]; a
    /// brick of exactly that length is not compressed.
    pub(super) fn pack(self, codes: &Codes) -> Vec<u8> {
        let plain = match codes {
            Codes::U8(codes) => codes.clone(),
            Codes::U16(codes) => codes.iter().flat_map(|code| code.to_le_bytes()).collect(),
        };
        match self {
            Codec::Zstd => todo!(),
            Codec::None => plain,
            Codec::Lz4 => {
                let packed = lz4_flex::block::compress(&plain);
                if packed.len() < plain.len() { packed } else { plain }
            }
        }
    }

    /// The inverse of [`Codec::pack`].
    ///
    /// # Errors
    /// What is wrong with the bytes.
    pub(super) fn unpack(self, bytes: &[u8], bits: CodeBits) -> Result<Codes, String> {
        if bytes.len() == bits.brick_bytes() {
            return Ok(codes(bytes, bits));
        }
        match self {
            Codec::Zstd => todo!(),
            Codec::None => Err(format!("it has {} bytes instead of {}", bytes.len(), bits.brick_bytes())),
            Codec::Lz4 => {
                let mut plain = vec![0; bits.brick_bytes()];
                let length =
                    lz4_flex::block::decompress_into(bytes, &mut plain).map_err(|cause| cause.to_string())?;
                if length != plain.len() {
                    return Err(format!("it unpacks to {length} bytes instead of {}", plain.len()));
                }
                Ok(codes(&plain, bits))
            }
        }
    }
}

fn codes(plain: &[u8], bits: CodeBits) -> Codes {
    match bits {
        CodeBits::Eight => Codes::U8(plain[..BRICK_VOXELS].to_vec()),
        CodeBits::Sixteen => {
            Codes::U16(plain.as_chunks().0.iter().map(|&code| u16::from_le_bytes(code)).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_unpacks_again() {
        let smooth = Codes::U16((0..BRICK_VOXELS).map(|i| (i / 64) as u16).collect());
        let noise = Codes::U8(
            (0..BRICK_VOXELS as u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect(),
        );
        for codec in [Codec::None, Codec::Lz4] {
            assert_eq!(codec.unpack(&codec.pack(&smooth), CodeBits::Sixteen), Ok(smooth.clone()));
            assert_eq!(codec.unpack(&codec.pack(&noise), CodeBits::Eight), Ok(noise.clone()));
        }
        assert!(Codec::Lz4.pack(&smooth).len() < CodeBits::Sixteen.brick_bytes());
    }

    #[test]
    fn damaged_bytes_are_an_error() {
        let bytes = Codec::Lz4.pack(&Codes::U8((0..BRICK_VOXELS).map(|i| (i / 99) as u8).collect()));
        assert!(Codec::Lz4.unpack(&bytes[..bytes.len() / 2], CodeBits::Eight).is_err());
        assert!(Codec::Lz4.unpack(&bytes, CodeBits::Sixteen).is_err());
        assert!(Codec::Lz4.unpack(&[], CodeBits::Eight).is_err());
        assert!(Codec::None.unpack(&[1, 2, 3], CodeBits::Eight).is_err());
    }
}
