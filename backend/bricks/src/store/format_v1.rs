//! The bytes of a store file of version 1, which is read and no longer written; all numbers are little-endian.
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

use super::Codec;
use super::bytes::{f32_at, f64_at, u32_at, u64_at};
use super::entry::{Entry, Extent};
use super::format::{Header, HeaderError, LONGEST_NAME, VERSION_AT, bits_of, damaged};
use crate::volume::{Modality, VolumeFrame};
use glam::{DVec3, UVec3};

/// The version of the format described here.
pub(super) const VERSION: u32 = 1;

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

/// Reads a header from the start of a file; what the numbers promise is for the caller to check.
pub(super) fn header(bytes: &[u8]) -> Result<Header, HeaderError> {
    if bytes.len() < HEADER_BYTES {
        return Err(damaged("it ends within its header"));
    }
    let unknown =
        || damaged(format!("{} bits per code with codec {} do not exist", bytes[BITS_AT], bytes[CODEC_AT]));
    let bits = bits_of(bytes[BITS_AT]).ok_or_else(unknown)?;
    let codec =
        Codec::of_number(bytes[CODEC_AT]).filter(|&codec| codec != Codec::Zstd).ok_or_else(unknown)?;
    let f64_of = |at: usize, axis: usize| f64_at(bytes, at + axis * size_of::<f64>());
    let source_name = name(bytes)?;
    let voxel_size_m = DVec3::from_array([0, 1, 2].map(|axis| f64_of(VOXEL_SIZE_AT, axis)));
    Ok(Header {
        bits,
        codec,
        has_deviation: false,
        dims: UVec3::from_array([0, 1, 2].map(|axis| u32_at(bytes, DIMS_AT + axis * size_of::<u32>()))),
        frame: VolumeFrame::of_voxels(voxel_size_m),
        modality: Modality::Unknown,
        value_range: (f64_of(RANGE_AT, 0), f64_of(RANGE_AT, 1)),
        nodes: u64_at(bytes, NODES_AT),
        table_offset: (HEADER_BYTES + source_name.len()).next_multiple_of(TABLE_ALIGNMENT) as u64,
        stored_bricks: None,
        levels: Vec::new(),
        source_name,
    })
}

fn name(bytes: &[u8]) -> Result<String, HeaderError> {
    let length = u32_at(bytes, NAME_LENGTH_AT) as usize;
    let name = bytes[HEADER_BYTES..].get(..length).filter(|name| name.len() <= LONGEST_NAME);
    match name.map(str::from_utf8) {
        Some(Ok(name)) => Ok(name.into()),
        _ => Err(damaged(format!("the source's name of {length} bytes cannot be read"))),
    }
}

/// What the table says of a node: no checksum, no children.
pub(super) fn entry(bytes: &[u8; ENTRY_BYTES]) -> Entry {
    let extent =
        Extent { offset: u64_at(bytes, OFFSET_AT), codes: u32_at(bytes, LENGTH_AT), ..Extent::default() };
    Entry {
        min: f32_at(bytes, MIN_AT),
        max: f32_at(bytes, MAX_AT),
        low: f32_at(bytes, LOW_AT),
        step: f32_at(bytes, STEP_AT),
        extent,
        ..Entry::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_those_of_the_description() {
        assert_eq!((BITS_AT, DIMS_AT, NAME_LENGTH_AT, VOXEL_SIZE_AT), (12, 16, 28, 32));
        assert_eq!((RANGE_AT, NODES_AT, RESERVED_AT, HEADER_BYTES, ENTRY_BYTES), (56, 72, 80, 128, 32));
    }
}
