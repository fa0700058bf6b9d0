//! Stores whose numbers lie and whose checksums are right: whatever they say, reading them does not panic.

use super::build_tests::{Grid, build_in, options};
use super::resign::{Repair, resign};
use super::*;
use crate::volume::Element;
use glam::UVec3;
use std::path::Path;

const SEED: u64 = 0x6c6c_6f6f_6d02;
/// Spoiled stores of each kind.
const STORES: usize = 2000;
/// Nodes read of each depth: few entries can be those of an octree of any size.
const NODES_PER_DEPTH: usize = 6;

/// Numbers that follow each other without a pattern (Knuth's 64-bit congruential generator).
pub(super) struct Random(pub(super) u64);

impl Random {
    /// A number from 0 to `end` − 1.
    pub(super) fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % end as u64) as usize
    }
}

fn store_bytes(folder: &Path, codec: Codec, has_deviation: bool) -> Vec<u8> {
    let mut grid = Grid::new(UVec3::new(30, 5, 4), Element::U16, |p| f64::from(p.x * p.y + p.z));
    let options = BuildOptions { has_deviation, ..options(CodeBits::Sixteen, codec) };
    build_in(folder, &mut grid, &options);
    std::fs::read(folder.join("grid.lloom")).unwrap()
}

/// Changes a few numbers, most of them in the header and the table.
fn spoil(bytes: &mut [u8], table: usize, random: &mut Random) {
    for _ in 0..=random.below(3) {
        let range = [8..256, table..bytes.len(), 256..table][[0, 0, 1, 1, 1, 2][random.below(6)]].clone();
        let at = range.start + random.below(range.len());
        match random.below(4) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
            2 => bytes[at] = random.below(256) as u8,
            // A whole number, as its field is aligned.
            _ => {
                let at = at - (at - range.start) % 4;
                let value = [0u32, 1, 0x7f80_0000, 0x7fff_ffff, u32::MAX][random.below(5)];
                bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
            }
        }
    }
}

/// Reads some of all that there is; false if it cannot even be opened.
fn read_some(bytes: Vec<u8>) -> bool {
    let Ok(store) = Store::from_bytes(Path::new("hostile.lloom"), bytes) else { return false };
    let shape = store.shape();
    for node in (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth).take(NODES_PER_DEPTH)) {
        let NodeSummary { min, max } = store.summary(node);
        assert!(min <= max && min.is_finite() && max.is_finite(), "{node}: {min} to {max}");
        let _ = (store.brick(node), store.cells(node), store.stored_bytes(node));
    }
    store.verify(&|_, _| {});
    true
}

#[test]
fn lies_with_right_checksums_do_no_harm() {
    println!("seed {SEED:#x}");
    let (folder, mut random) = (tempfile::tempdir().unwrap(), Random(SEED));
    for (codec, has_deviation) in [(Codec::None, false), (Codec::Lz4, true), (Codec::Zstd, false)] {
        let whole = store_bytes(folder.path(), codec, has_deviation);
        let table = whole.len() - 3 * entry::ENTRY_BYTES;
        let mut opened = 0;
        for _ in 0..STORES {
            let mut bytes = whole.clone();
            spoil(&mut bytes, table, &mut random);
            resign(&mut bytes, Repair { table: random.below(4) > 0, ..Repair::ALL });
            opened += usize::from(read_some(bytes));
        }
        assert!(opened > STORES / 2, "only {opened} of {STORES} lies were believed");
    }
}

#[test]
fn what_is_right_stays_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    for codec in [Codec::None, Codec::Lz4, Codec::Zstd] {
        let whole = store_bytes(folder.path(), codec, true);
        let mut signed = whole.clone();
        resign(&mut signed, Repair::ALL);
        assert!(signed == whole, "{codec:?}");
        // And what is wrong is put right: the checksums of header, entry and extent.
        let table = whole.len() - 3 * entry::ENTRY_BYTES;
        for at in [12, table + 60, table + 40, table + 44] {
            signed[at] ^= 1;
            resign(&mut signed, Repair::ALL);
            assert!(signed == whole, "byte {at} with {codec:?}");
        }
    }
}

/// An entry without children that says where they are, within the table or far beyond it.
#[test]
fn children_of_a_leaf_are_a_damage() {
    let folder = tempfile::tempdir().unwrap();
    let whole = store_bytes(folder.path(), Codec::Lz4, false);
    let last = whole.len() - entry::ENTRY_BYTES;
    for first_child in [1, 2, 3, 4, 1 << 20, u64::MAX] {
        let mut bytes = whole.clone();
        assert_eq!(bytes[last + 56], 0, "the last entry has no children");
        bytes[last + 48..last + 56].copy_from_slice(&u64::to_le_bytes(first_child));
        resign(&mut bytes, Repair { places: false, ..Repair::ALL });
        let store = Store::from_bytes(Path::new("hostile.lloom"), bytes).unwrap();
        let found = store.verify(&|_, _| {});
        let named = found.damages.iter().any(|what| what.contains("entry 2 of the table"));
        assert!(named, "{first_child}: {:?}", found.damages);
    }
}

#[test]
fn values_beyond_f32_are_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = store_bytes(folder.path(), Codec::Lz4, false);
    bytes[136..144].copy_from_slice(&1e300f64.to_le_bytes());
    resign(&mut bytes, Repair::ALL);
    let said = Store::from_bytes(Path::new("hostile.lloom"), bytes).unwrap_err().to_string();
    assert!(said.contains("hostile.lloom") && said.contains("range from 0 to 1"), "{said}");
}
