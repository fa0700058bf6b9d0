//! The table of a store file, version 2: entries of 64 bytes to the end of the file.
//!
//! They list the octree in breadth-first order, the children of a node one after the
//! other, x fastest. The root comes first; an entry without children also describes all nodes below it.
//!
//! | bytes | what |
//! | --- | --- |
//! | 0..8 | bounds of the stored samples of the node and all below it, f32 each |
//! | 8..16 | low, step, f32 each |
//! | 16..20 | deviation step, f32 |
//! | 20..32 | lengths of cells, codes and deviations in bytes, u32 each; 0 if all zero |
//! | 32..40 | offset of the extent in the file, u64; 0 if it is empty |
//! | 40..48 | checksum of the cells; checksum of codes and deviations, u32 each |
//! | 48..56 | place of the first child in the table, u64; 0 if there is none |
//! | 56 | children that are in the table, bit 0 = x, y, z low |
//! | 57..60 | zero |
//! | 60..64 | checksum of the entry's first 60 bytes |

use super::bytes::{checksum, f32_at, u32_at, u64_at};

const MIN_AT: usize = 0;
const MAX_AT: usize = MIN_AT + size_of::<f32>();
const LOW_AT: usize = MAX_AT + size_of::<f32>();
const STEP_AT: usize = LOW_AT + size_of::<f32>();
const DEVIATION_STEP_AT: usize = STEP_AT + size_of::<f32>();
const CELLS_LENGTH_AT: usize = DEVIATION_STEP_AT + size_of::<f32>();
const CODES_LENGTH_AT: usize = CELLS_LENGTH_AT + size_of::<u32>();
const DEVIATION_LENGTH_AT: usize = CODES_LENGTH_AT + size_of::<u32>();
const OFFSET_AT: usize = DEVIATION_LENGTH_AT + size_of::<u32>();
const CELLS_CHECKSUM_AT: usize = OFFSET_AT + size_of::<u64>();
const VOXELS_CHECKSUM_AT: usize = CELLS_CHECKSUM_AT + size_of::<u32>();
const FIRST_CHILD_AT: usize = VOXELS_CHECKSUM_AT + size_of::<u32>();
const CHILDREN_AT: usize = FIRST_CHILD_AT + size_of::<u64>();
const ENTRY_CHECKSUM_AT: usize = CHILDREN_AT + 4;
/// Bytes of a node's entry.
pub(super) const ENTRY_BYTES: usize = ENTRY_CHECKSUM_AT + size_of::<u32>();

/// What the table says of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Entry {
    pub min: f32,
    pub max: f32,
    pub low: f32,
    pub step: f32,
    pub deviation_step: f32,
    pub extent: Extent,
    pub first_child: u64,
    /// Bit per octant.
    pub children: u8,
}

/// Where a brick's blocks are, and their checksums.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extent {
    pub offset: u64,
    pub cells: u32,
    pub codes: u32,
    pub deviation: u32,
    /// None in files of version 1.
    pub checksums: Option<Checksums>,
}

/// Checksums of an extent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Checksums {
    pub cells: u32,
    pub voxels: u32,
}

impl Extent {
    pub fn bytes(&self) -> u64 {
        u64::from(self.cells) + u64::from(self.codes) + u64::from(self.deviation)
    }
}

impl Entry {
    pub fn to_bytes(self) -> [u8; ENTRY_BYTES] {
        let mut bytes = [0; ENTRY_BYTES];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        let numbers = [self.min, self.max, self.low, self.step, self.deviation_step];
        for (i, number) in numbers.into_iter().enumerate() {
            put(MIN_AT + i * size_of::<f32>(), &number.to_le_bytes());
        }
        let Extent { offset, cells, codes, deviation, checksums } = self.extent;
        let checksums = checksums.unwrap_or_default();
        put(CELLS_LENGTH_AT, &cells.to_le_bytes());
        put(CODES_LENGTH_AT, &codes.to_le_bytes());
        put(DEVIATION_LENGTH_AT, &deviation.to_le_bytes());
        put(OFFSET_AT, &offset.to_le_bytes());
        put(CELLS_CHECKSUM_AT, &checksums.cells.to_le_bytes());
        put(VOXELS_CHECKSUM_AT, &checksums.voxels.to_le_bytes());
        put(FIRST_CHILD_AT, &self.first_child.to_le_bytes());
        put(CHILDREN_AT, &[self.children]);
        let sum = checksum(&bytes[..ENTRY_CHECKSUM_AT]);
        bytes[ENTRY_CHECKSUM_AT..].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// None if the checksum differs.
    pub fn from_bytes(bytes: &[u8; ENTRY_BYTES]) -> Option<Self> {
        if checksum(&bytes[..ENTRY_CHECKSUM_AT]) != u32_at(bytes, ENTRY_CHECKSUM_AT) {
            return None;
        }
        let checksums =
            Checksums { cells: u32_at(bytes, CELLS_CHECKSUM_AT), voxels: u32_at(bytes, VOXELS_CHECKSUM_AT) };
        Some(Self {
            min: f32_at(bytes, MIN_AT),
            max: f32_at(bytes, MAX_AT),
            low: f32_at(bytes, LOW_AT),
            step: f32_at(bytes, STEP_AT),
            deviation_step: f32_at(bytes, DEVIATION_STEP_AT),
            extent: Extent {
                offset: u64_at(bytes, OFFSET_AT),
                cells: u32_at(bytes, CELLS_LENGTH_AT),
                codes: u32_at(bytes, CODES_LENGTH_AT),
                deviation: u32_at(bytes, DEVIATION_LENGTH_AT),
                checksums: Some(checksums),
            },
            first_child: u64_at(bytes, FIRST_CHILD_AT),
            children: bytes[CHILDREN_AT],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_those_of_the_description() {
        assert_eq!((CELLS_LENGTH_AT, OFFSET_AT, CELLS_CHECKSUM_AT), (20, 32, 40));
        assert_eq!((FIRST_CHILD_AT, CHILDREN_AT, ENTRY_CHECKSUM_AT, ENTRY_BYTES), (48, 56, 60, 64));
    }

    #[test]
    fn an_entry_reads_back_whole_or_not_at_all() {
        let extent = Extent {
            offset: 1 << 40,
            cells: 7,
            codes: 77,
            deviation: 9,
            checksums: Some(Checksums { cells: 1, voxels: u32::MAX }),
        };
        let (min, max, low, step) = (-1.0, 2.0, -0.5, 0.25);
        let entry =
            Entry { min, max, low, step, deviation_step: 0.1, extent, first_child: 1 << 33, children: 0x81 };
        let bytes = entry.to_bytes();
        assert_eq!(Entry::from_bytes(&bytes), Some(entry));
        for bit in 0..8 * ENTRY_BYTES {
            let mut changed = bytes;
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(Entry::from_bytes(&changed), None, "bit {bit}");
        }
    }
}
