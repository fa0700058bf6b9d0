//! The bytes of a store file (`.lloom`), version 1; all numbers are little-endian.
//!
//! | bytes | what |
//! | --- | --- |
//! | 0..8 | magic `LLOOM\x1a\r\n` (a text-mode copy breaks it) |
//! | 8..12 | version, u32: 1 |
//! | 12 | bits per code, u8: 8 or 16 |
//! | 13 | codec, u8: 0 none, 1 LZ4 block |
//! | 14..16 | zero |
//! | 16..28 | voxels along x, y, z, u32 each |
//! | 28..32 | length N of the source's name in bytes, u32, at most 4096 |
//! | 32..56 | edges of a voxel in metres, f64 each |
//! | 56..72 | smallest and largest data value of the finest level, f64 each |
//! | 72..80 | number of nodes, u64 (it follows from the dimensions) |
//! | 80..128 | zero, reserved |
//! | 128..128+N | the source's name, UTF-8, then zeros up to a multiple of 32 |
//! | then | one entry of 32 bytes per node: depth 0 first, in a depth z slowest and x fastest |
//! | then | the bricks, in any order |
//!
//! An entry is min, max, low, step (f32 each), offset of the brick in the file (u64), its length in bytes (u32) and
//! four zero bytes, reserved for a checksum. min and max bound the stored samples of the node and all below it. A
//! brick is 32³ codes, x fastest, one or two bytes each; data value = low + code × step. With codec 1 a brick shorter
//! than that is an LZ4 block. A brick whose samples all equal `low` is not stored: length 0.

use super::{CodeBits, Codec};
use glam::{DVec3, UVec3};

pub(super) const MAGIC: [u8; 8] = *b"LLOOM\x1a\r\n";
/// The version of the format that this program writes and reads.
pub(super) const VERSION: u32 = 1;

const VERSION_AT: usize = MAGIC.len();
const BITS_AT: usize = VERSION_AT + size_of::<u32>();
const CODEC_AT: usize = BITS_AT + 1;
const DIMS_AT: usize = CODEC_AT + 1 + 2;
const NAME_LENGTH_AT: usize = DIMS_AT + 3 * size_of::<u32>();
const VOXEL_SIZE_AT: usize = NAME_LENGTH_AT + size_of::<u32>();
const RANGE_AT: usize = VOXEL_SIZE_AT + 3 * size_of::<f64>();
const NODES_AT: usize = RANGE_AT + 2 * size_of::<f64>();
const RESERVED_AT: usize = NODES_AT + size_of::<u64>();
/// Bytes before the name.
pub(super) const HEADER_BYTES: usize = RESERVED_AT + 48;
/// Longest name of a source in bytes.
pub(super) const LONGEST_NAME: usize = 4096;
/// Alignment of the table.
const TABLE_ALIGNMENT: usize = 32;

const MIN_AT: usize = 0;
const MAX_AT: usize = MIN_AT + size_of::<f32>();
const LOW_AT: usize = MAX_AT + size_of::<f32>();
const STEP_AT: usize = LOW_AT + size_of::<f32>();
const OFFSET_AT: usize = STEP_AT + size_of::<f32>();
const LENGTH_AT: usize = OFFSET_AT + size_of::<u64>();
const CHECKSUM_AT: usize = LENGTH_AT + size_of::<u32>();
/// Bytes of a node's entry.
pub(super) const ENTRY_BYTES: usize = CHECKSUM_AT + 4;

/// The header, without what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub bits: CodeBits,
    pub codec: Codec,
    pub dims: UVec3,
    pub voxel_size_m: DVec3,
    pub value_range: (f64, f64),
    pub nodes: u64,
    pub source_name: String,
}

/// Why bytes are no header.
#[derive(Debug, PartialEq)]
pub(super) enum HeaderError {
    NotAStore,
    Version(u32),
    Damaged(String),
}

impl Header {
    /// Where the table starts.
    pub fn table_offset(&self) -> u64 {
        (HEADER_BYTES + self.source_name.len()).next_multiple_of(TABLE_ALIGNMENT) as u64
    }

    /// Header, name and padding.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = vec![0; self.table_offset() as usize];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(0, &MAGIC);
        put(VERSION_AT, &VERSION.to_le_bytes());
        put(BITS_AT, &[self.bits.bits()]);
        put(
            CODEC_AT,
            &[match self.codec {
                Codec::None => 0,
                Codec::Lz4 => 1,
                Codec::Zstd => 2,
            }],
        );
        for axis in 0..3 {
            put(DIMS_AT + axis * size_of::<u32>(), &self.dims[axis].to_le_bytes());
            put(VOXEL_SIZE_AT + axis * size_of::<f64>(), &self.voxel_size_m[axis].to_le_bytes());
        }
        put(NAME_LENGTH_AT, &(self.source_name.len() as u32).to_le_bytes());
        put(RANGE_AT, &self.value_range.0.to_le_bytes());
        put(RANGE_AT + size_of::<f64>(), &self.value_range.1.to_le_bytes());
        put(NODES_AT, &self.nodes.to_le_bytes());
        put(HEADER_BYTES, self.source_name.as_bytes());
        bytes
    }

    /// Reads a header from the start of a file; what the numbers promise is for the caller to check.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, HeaderError> {
        check_version(bytes)?;
        let (bits, codec) = match (bytes[BITS_AT], bytes[CODEC_AT]) {
            (8, 0) => (CodeBits::Eight, Codec::None),
            (8, 1) => (CodeBits::Eight, Codec::Lz4),
            (16, 0) => (CodeBits::Sixteen, Codec::None),
            (16, 1) => (CodeBits::Sixteen, Codec::Lz4),
            (bits, codec) => {
                return Err(HeaderError::Damaged(format!(
                    "{bits} bits per code with codec {codec} do not exist"
                )));
            }
        };
        let f64_of = |at: usize, axis: usize| f64_at(bytes, at + axis * size_of::<f64>());
        Ok(Self {
            bits,
            codec,
            dims: UVec3::from_array([0, 1, 2].map(|axis| u32_at(bytes, DIMS_AT + axis * size_of::<u32>()))),
            voxel_size_m: DVec3::from_array([0, 1, 2].map(|axis| f64_of(VOXEL_SIZE_AT, axis))),
            value_range: (f64_of(RANGE_AT, 0), f64_of(RANGE_AT, 1)),
            nodes: u64_at(bytes, NODES_AT),
            source_name: name(bytes)?,
        })
    }
}

/// Passes bytes that start with a whole header of this version.
fn check_version(bytes: &[u8]) -> Result<(), HeaderError> {
    let cut = || HeaderError::Damaged("it ends within its header".into());
    if !bytes.starts_with(&MAGIC) {
        return Err(HeaderError::NotAStore);
    }
    if bytes.len() < BITS_AT {
        return Err(cut());
    }
    match u32_at(bytes, VERSION_AT) {
        VERSION if bytes.len() < HEADER_BYTES => Err(cut()),
        VERSION => Ok(()),
        other => Err(HeaderError::Version(other)),
    }
}

fn name(bytes: &[u8]) -> Result<String, HeaderError> {
    let length = u32_at(bytes, NAME_LENGTH_AT) as usize;
    let name = bytes[HEADER_BYTES..].get(..length).filter(|name| name.len() <= LONGEST_NAME);
    match name.map(str::from_utf8) {
        Some(Ok(name)) => Ok(name.into()),
        _ => Err(HeaderError::Damaged(format!("the source's name of {length} bytes cannot be read"))),
    }
}

/// What the table says of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Entry {
    pub min: f32,
    pub max: f32,
    pub low: f32,
    pub step: f32,
    pub offset: u64,
    /// Bytes of the brick; 0 where all samples equal `low`.
    pub length: u32,
}

impl Entry {
    pub fn to_bytes(self) -> [u8; ENTRY_BYTES] {
        let mut bytes = [0; ENTRY_BYTES];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(MIN_AT, &self.min.to_le_bytes());
        put(MAX_AT, &self.max.to_le_bytes());
        put(LOW_AT, &self.low.to_le_bytes());
        put(STEP_AT, &self.step.to_le_bytes());
        put(OFFSET_AT, &self.offset.to_le_bytes());
        put(LENGTH_AT, &self.length.to_le_bytes());
        bytes
    }

    pub fn from_bytes(bytes: &[u8; ENTRY_BYTES]) -> Self {
        let f32_at = |at| f32::from_bits(u32_at(bytes, at));
        Self {
            min: f32_at(MIN_AT),
            max: f32_at(MAX_AT),
            low: f32_at(LOW_AT),
            step: f32_at(STEP_AT),
            offset: u64_at(bytes, OFFSET_AT),
            length: u32_at(bytes, LENGTH_AT),
        }
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

fn f64_at(bytes: &[u8], at: usize) -> f64 {
    f64::from_bits(u64_at(bytes, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_those_of_the_description() {
        assert_eq!((BITS_AT, DIMS_AT, NAME_LENGTH_AT, VOXEL_SIZE_AT), (12, 16, 28, 32));
        assert_eq!((RANGE_AT, NODES_AT, RESERVED_AT, HEADER_BYTES, ENTRY_BYTES), (56, 72, 80, 128, 32));
    }

    #[test]
    fn a_header_reads_back() {
        let header = Header {
            bits: CodeBits::Sixteen,
            codec: Codec::Lz4,
            dims: UVec3::new(1, 2, 3),
            voxel_size_m: DVec3::new(1e-3, 2e-3, 3e-3),
            value_range: (-1.5, 7.0),
            nodes: 1,
            source_name: "größe.nrrd".into(),
        };
        let bytes = header.to_bytes();
        assert_eq!(bytes.len() % TABLE_ALIGNMENT, 0);
        assert_eq!(Header::from_bytes(&bytes), Ok(header));
        assert_eq!(Header::from_bytes(b"GIF89a"), Err(HeaderError::NotAStore));
        for length in MAGIC.len()..bytes.len() - TABLE_ALIGNMENT {
            assert!(matches!(Header::from_bytes(&bytes[..length]), Err(HeaderError::Damaged(_))));
        }
    }

    #[test]
    fn an_entry_reads_back() {
        let entry = Entry { min: -1.0, max: 2.0, low: -0.5, step: 0.25, offset: 1 << 40, length: 77 };
        assert_eq!(Entry::from_bytes(&entry.to_bytes()), entry);
    }
}
