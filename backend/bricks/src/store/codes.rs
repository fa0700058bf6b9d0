//! The quantised samples of a brick, and how many there are.

pub use layout::brick::{EDGE as BRICK_EDGE, OVERLAP, OWN_EDGE, VOXELS as BRICK_VOXELS};

/// The quantised samples of a brick, x fastest, then y, then z; always [`BRICK_VOXELS`] of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Codes {
    /// 8 bits per sample.
    U8(Vec<u8>),
    /// 16 bits per sample.
    U16(Vec<u16>),
}

impl Codes {
    /// The code at a stored index.
    pub fn at(&self, index: usize) -> u16 {
        match self {
            Codes::U8(codes) => u16::from(codes[index]),
            Codes::U16(codes) => codes[index],
        }
    }

    /// The largest code there can be: 255 or 65535.
    pub fn largest(&self) -> u16 {
        match self {
            Codes::U8(_) => u16::from(u8::MAX),
            Codes::U16(_) => u16::MAX,
        }
    }
}

/// Bits per stored sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeBits {
    /// 256 codes per brick.
    Eight,
    /// 65536 codes per brick.
    Sixteen,
}

impl CodeBits {
    /// 8 or 16.
    pub fn bits(self) -> u8 {
        match self {
            CodeBits::Eight => 8,
            CodeBits::Sixteen => 16,
        }
    }

    /// The largest code.
    pub fn largest(self) -> u16 {
        match self {
            CodeBits::Eight => 255,
            CodeBits::Sixteen => 65535,
        }
    }

    /// Bytes of a brick's codes.
    pub fn brick_bytes(self) -> usize {
        BRICK_VOXELS * usize::from(self.bits()) / 8
    }
}
