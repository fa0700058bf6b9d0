//! The bytes of a store file (`.lloom`), version 2; all numbers are little-endian, all checksums CRC-32 (IEEE).
//!
//! # Header
//!
//! | bytes | what |
//! | --- | --- |
//! | 0..8 | magic `LLOOM\x1a\r\n` (a text-mode copy breaks it) |
//! | 8..12 | version, u32: 2 |
//! | 12..16 | checksum of the whole header, these four bytes taken as zero |
//! | 16 | bits per code, u8: 8 or 16 |
//! | 17 | codec, u8: 0 none, 1 LZ4 block, 2 Zstandard frame |
//! | 18 | u8: 1 if coarse levels keep standard deviations, else 0 |
//! | 19 | space of the axes, u8: 0 unknown, 1 a patient's (left, back, head) |
//! | 20..32 | voxels along x, y, z, u32 each |
//! | 32..104 | from a voxel to the next along x, y, z: three vectors in metres, f64 each |
//! | 104..128 | centre of the first voxel in metres, f64 each |
//! | 128..144 | smallest and largest data value of the finest level, f64 each |
//! | 144..152 | nodes in the table T, u64 |
//! | 152..160 | offset of the table in the file, u64 |
//! | 160..164 | length N of the source's name in bytes, u32, at most 4096 |
//! | 164..168 | levels L of the octree, u32 |
//! | 168..176 | bricks that take bytes, u64 |
//! | 176 | modality, u8: 0 unknown, 1 CT (values are Hounsfield units), 2 MR |
//! | 177..192 | zero |
//! | 192..192+16L | of each level, the finest first: RMS and largest error against the source, f64 each |
//! | then N bytes | the source's name, UTF-8, then zeros up to a multiple of 64: the header's end |
//!
//! # Bricks
//!
//! From the header's end to the table, one extent after the other without gaps, in any order. An extent holds a
//! brick's cells, its codes and its deviations, each a block: 32³ codes, x fastest, one or two bytes each, data value
//! = low + code × step; 8³ cells, x fastest, the smallest and the largest code around each, of the codes' size; 32³
//! deviations of one byte each, standard deviation = byte × deviation step. With a codec, a block shorter than that is
//! compressed by it.
//!
//! # Table
//!
//! From its offset to the end of the file: the module `entry` describes it.

use super::bytes::{checksum, f64_at, u32_at, u64_at};
use super::{CodeBits, Codec, LevelError};
use crate::volume::{Modality, Space, VolumeFrame};
use glam::{DMat3, DVec3, UVec3};

pub(super) const MAGIC: [u8; 8] = *b"LLOOM\x1a\r\n";
/// The version of the format that this program writes.
pub(super) const VERSION: u32 = 2;

pub(super) const VERSION_AT: usize = MAGIC.len();
const CHECKSUM_AT: usize = VERSION_AT + size_of::<u32>();
const BITS_AT: usize = CHECKSUM_AT + size_of::<u32>();
const CODEC_AT: usize = BITS_AT + 1;
const DEVIATION_AT: usize = CODEC_AT + 1;
const SPACE_AT: usize = DEVIATION_AT + 1;
const DIMS_AT: usize = SPACE_AT + 1;
const AXES_AT: usize = DIMS_AT + 3 * size_of::<u32>();
const ORIGIN_AT: usize = AXES_AT + 9 * size_of::<f64>();
const RANGE_AT: usize = ORIGIN_AT + 3 * size_of::<f64>();
const NODES_AT: usize = RANGE_AT + 2 * size_of::<f64>();
const TABLE_AT: usize = NODES_AT + size_of::<u64>();
const NAME_LENGTH_AT: usize = TABLE_AT + size_of::<u64>();
const LEVELS_AT: usize = NAME_LENGTH_AT + size_of::<u32>();
const STORED_AT: usize = LEVELS_AT + size_of::<u32>();
const MODALITY_AT: usize = STORED_AT + size_of::<u64>();
/// Bytes of the header before what has no fixed length.
pub(super) const FIXED_BYTES: usize = MODALITY_AT + 16;
/// Bytes of a level's errors.
const LEVEL_BYTES: usize = 2 * size_of::<f64>();
/// Longest name of a source in bytes.
pub(super) const LONGEST_NAME: usize = 4096;
/// More levels than 2^20 voxels along an axis make.
const MOST_LEVELS: usize = 32;
const HEADER_ALIGNMENT: usize = 64;
/// No header is longer.
pub(super) const LONGEST_HEADER: usize =
    (FIXED_BYTES + MOST_LEVELS * LEVEL_BYTES + LONGEST_NAME).next_multiple_of(HEADER_ALIGNMENT);

/// The header.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub bits: CodeBits,
    pub codec: Codec,
    pub has_deviation: bool,
    pub dims: UVec3,
    pub frame: VolumeFrame,
    pub modality: Modality,
    pub value_range: (f64, f64),
    /// Entries of the table.
    pub nodes: u64,
    pub table_offset: u64,
    /// Bricks that take bytes; None in files of version 1.
    pub stored_bricks: Option<u64>,
    /// The finest first.
    pub levels: Vec<LevelError>,
    pub source_name: String,
}

/// Why bytes are not a header.
#[derive(Debug, PartialEq)]
pub(super) enum HeaderError {
    NotAStore,
    Version(u32),
    Damaged(String),
}

pub(super) fn damaged(what: impl Into<String>) -> HeaderError {
    HeaderError::Damaged(what.into())
}

impl Header {
    /// Bytes of the whole header: where the bricks start.
    pub fn length(&self) -> u64 {
        header_length(self.levels.len(), self.source_name.len()) as u64
    }

    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = vec![0; self.length() as usize];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(0, &MAGIC);
        put(VERSION_AT, &VERSION.to_le_bytes());
        put(BITS_AT, &[self.bits.bits(), self.codec.number(), u8::from(self.has_deviation)]);
        put(SPACE_AT, &[space_number(self.frame.space)]);
        for axis in 0..3 {
            put(DIMS_AT + axis * size_of::<u32>(), &self.dims[axis].to_le_bytes());
        }
        let [low, high] = [self.value_range.0, self.value_range.1];
        let frame = self.frame.axes_m.to_cols_array().into_iter().chain(self.frame.origin_m.to_array());
        for (i, number) in frame.chain([low, high]).enumerate() {
            put(AXES_AT + i * size_of::<f64>(), &number.to_le_bytes());
        }
        put(NODES_AT, &self.nodes.to_le_bytes());
        put(TABLE_AT, &self.table_offset.to_le_bytes());
        put(NAME_LENGTH_AT, &(self.source_name.len() as u32).to_le_bytes());
        put(LEVELS_AT, &(self.levels.len() as u32).to_le_bytes());
        put(STORED_AT, &self.stored_bricks.unwrap_or_default().to_le_bytes());
        put(MODALITY_AT, &[modality_number(self.modality)]);
        for (i, level) in self.levels.iter().enumerate() {
            put(FIXED_BYTES + i * LEVEL_BYTES, &level.rms.to_le_bytes());
            put(FIXED_BYTES + i * LEVEL_BYTES + size_of::<f64>(), &level.max.to_le_bytes());
        }
        put(FIXED_BYTES + self.levels.len() * LEVEL_BYTES, self.source_name.as_bytes());
        let sum = checksum(&bytes);
        bytes[CHECKSUM_AT..CHECKSUM_AT + 4].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Reads a header from the start of a file; what the numbers promise is for the caller to check.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, HeaderError> {
        let cut = || damaged("it ends within its header");
        let fixed = bytes.get(..FIXED_BYTES).ok_or_else(cut)?;
        let (levels, name) = (u32_at(fixed, LEVELS_AT) as usize, u32_at(fixed, NAME_LENGTH_AT) as usize);
        if levels > MOST_LEVELS || name > LONGEST_NAME {
            return Err(damaged(format!("{levels} levels and a name of {name} bytes are too many")));
        }
        let mut whole = bytes.get(..header_length(levels, name)).ok_or_else(cut)?.to_vec();
        let sum = u32_at(&whole, CHECKSUM_AT);
        whole[CHECKSUM_AT..CHECKSUM_AT + 4].fill(0);
        if checksum(&whole) != sum {
            return Err(damaged("the checksum of its header differs"));
        }
        Self::parse(&whole, levels, name)
    }

    fn parse(bytes: &[u8], levels: usize, name: usize) -> Result<Self, HeaderError> {
        let numbers: [f64; 14] = std::array::from_fn(|i| f64_at(bytes, AXES_AT + i * size_of::<f64>()));
        let level = |i: usize| LevelError {
            rms: f64_at(bytes, FIXED_BYTES + i * LEVEL_BYTES),
            max: f64_at(bytes, FIXED_BYTES + i * LEVEL_BYTES + size_of::<f64>()),
        };
        let name = &bytes[FIXED_BYTES + levels * LEVEL_BYTES..][..name];
        let unknown = |what: &str, number: u8| damaged(format!("it has the unknown {what} {number}"));
        Ok(Self {
            bits: bits_of(bytes[BITS_AT]).ok_or_else(|| unknown("number of bits", bytes[BITS_AT]))?,
            codec: Codec::of_number(bytes[CODEC_AT]).ok_or_else(|| unknown("codec", bytes[CODEC_AT]))?,
            has_deviation: bytes[DEVIATION_AT] != 0,
            dims: UVec3::from_array([0, 1, 2].map(|axis| u32_at(bytes, DIMS_AT + axis * size_of::<u32>()))),
            frame: VolumeFrame {
                axes_m: DMat3::from_cols_slice(&numbers[..9]),
                origin_m: DVec3::from_slice(&numbers[9..12]),
                space: space_of(bytes[SPACE_AT]).ok_or_else(|| unknown("space", bytes[SPACE_AT]))?,
            },
            modality: modality_of(bytes[MODALITY_AT])
                .ok_or_else(|| unknown("modality", bytes[MODALITY_AT]))?,
            value_range: (numbers[12], numbers[13]),
            nodes: u64_at(bytes, NODES_AT),
            table_offset: u64_at(bytes, TABLE_AT),
            stored_bricks: Some(u64_at(bytes, STORED_AT)),
            levels: (0..levels).map(level).collect(),
            source_name: str::from_utf8(name)
                .map_err(|_| damaged("the source's name is not UTF-8 text"))?
                .into(),
        })
    }
}

/// The version of a file that starts with these bytes.
pub(super) fn version(bytes: &[u8]) -> Result<u32, HeaderError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(HeaderError::NotAStore);
    }
    match bytes.len() >= VERSION_AT + size_of::<u32>() {
        true => Ok(u32_at(bytes, VERSION_AT)),
        false => Err(damaged("it ends within its header")),
    }
}

fn header_length(levels: usize, name: usize) -> usize {
    (FIXED_BYTES + levels * LEVEL_BYTES + name).next_multiple_of(HEADER_ALIGNMENT)
}

pub(super) fn bits_of(number: u8) -> Option<CodeBits> {
    [CodeBits::Eight, CodeBits::Sixteen].into_iter().find(|bits| bits.bits() == number)
}

fn space_number(space: Space) -> u8 {
    match space {
        Space::Unknown => 0,
        Space::Patient => 1,
    }
}

fn space_of(number: u8) -> Option<Space> {
    [Space::Unknown, Space::Patient].into_iter().find(|&space| space_number(space) == number)
}

fn modality_number(modality: Modality) -> u8 {
    match modality {
        Modality::Unknown => 0,
        Modality::Ct => 1,
        Modality::Mr => 2,
    }
}

fn modality_of(number: u8) -> Option<Modality> {
    [Modality::Unknown, Modality::Ct, Modality::Mr]
        .into_iter()
        .find(|&modality| modality_number(modality) == number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_those_of_the_description() {
        assert_eq!((CHECKSUM_AT, BITS_AT, SPACE_AT, DIMS_AT, AXES_AT), (12, 16, 19, 20, 32));
        assert_eq!((ORIGIN_AT, RANGE_AT, NODES_AT, TABLE_AT), (104, 128, 144, 152));
        assert_eq!((NAME_LENGTH_AT, LEVELS_AT, STORED_AT), (160, 164, 168));
        assert_eq!((MODALITY_AT, FIXED_BYTES), (176, 192));
    }

    fn header() -> Header {
        let axes_m = DMat3::from_cols(DVec3::Y * 1e-3, DVec3::X * -2e-3, DVec3::Z * 3e-3);
        Header {
            bits: CodeBits::Sixteen,
            codec: Codec::Zstd,
            has_deviation: true,
            dims: UVec3::new(1, 2, 3),
            frame: VolumeFrame { axes_m, origin_m: DVec3::new(1.0, 2.0, -3.0), space: Space::Patient },
            modality: Modality::Mr,
            value_range: (-1.5, 7.0),
            nodes: 1,
            table_offset: 4711,
            stored_bricks: Some(1),
            levels: vec![LevelError { rms: 0.5, max: 2.0 }, LevelError { rms: 1.5, max: 3.0 }],
            source_name: "größe.nrrd".into(),
        }
    }

    #[test]
    fn a_header_reads_back() {
        let bytes = header().to_bytes();
        assert_eq!(bytes.len(), 256);
        assert_eq!(Header::from_bytes(&bytes), Ok(header()));
        assert_eq!(version(&bytes), Ok(VERSION));
        assert_eq!(version(b"GIF89a"), Err(HeaderError::NotAStore));
        for length in 0..bytes.len() {
            assert!(Header::from_bytes(&bytes[..length]).is_err());
        }
    }

    #[test]
    fn every_changed_bit_of_a_header_is_found() {
        let bytes = header().to_bytes();
        for bit in 8 * VERSION_AT + 32..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert!(Header::from_bytes(&changed).is_err(), "bit {bit}");
        }
    }
}
