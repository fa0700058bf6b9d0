//! Damaged and hostile stores: each is an error in words, none a panic.

use super::build_tests::{Grid, build_in, options};
use super::table::Table;
use super::*;
use crate::procedural::ProceduralVolume;
use crate::volume::Element;
use glam::UVec3;
use std::path::Path;

/// What is said of a store with these bytes, at opening or at reading any brick.
fn complaint(folder: &Path, bytes: &[u8]) -> Option<String> {
    let path = folder.join("damaged.lloom");
    std::fs::write(&path, bytes).unwrap();
    let said = match Store::open(&path) {
        Err(error) => error.to_string(),
        Ok(store) => {
            let shape = store.shape();
            let mut nodes = (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth));
            nodes.find_map(|node| store.brick(node).err())?.to_string()
        }
    };
    assert!(said.contains("damaged.lloom") && !said.contains('\n'), "{said}");
    Some(said)
}

fn store_bytes(folder: &Path, codec: Codec) -> Vec<u8> {
    let mut grid = Grid::new(UVec3::new(40, 20, 30), Element::U16, |p| f64::from(p.x * p.y + p.z));
    build_in(folder, &mut grid, &options(CodeBits::Sixteen, codec));
    std::fs::read(folder.join("grid.lloom")).unwrap()
}

#[test]
fn a_store_of_another_version_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = store_bytes(folder.path(), Codec::None);
    assert_eq!(complaint(folder.path(), &bytes), None);
    bytes[8] = 7;
    let said = complaint(folder.path(), &bytes).unwrap();
    assert!(
        said.contains("version 7") && said.contains("reads versions 1 to 2") && said.contains("import"),
        "{said}"
    );
    assert!(complaint(folder.path(), b"").unwrap().contains("not a lightloom store"));
    assert!(complaint(folder.path(), b"NRRD0004").unwrap().contains("not a lightloom store"));
}

#[test]
fn a_store_cut_short_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = store_bytes(folder.path(), Codec::Lz4);
    for length in (0..bytes.len() - 1).step_by(bytes.len() / 40).chain(100..170) {
        assert!(complaint(folder.path(), &bytes[..length]).is_some(), "cut to {length} bytes");
    }
}

#[test]
fn what_cannot_be_read_now_may_be_read_later() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = store_bytes(folder.path(), Codec::Lz4);
    let path = folder.path().join("grid.lloom");
    let store = Store::open(&path).unwrap();
    std::fs::write(&path, &bytes[..100]).unwrap();
    let error = store.brick(NodeKey::ROOT).unwrap_err();
    assert_eq!(error.kind, BrickErrorKind::Unavailable, "{error}");
    assert!(error.to_string().starts_with("cannot read brick 0/0,0,0 of "), "{error}");
    std::fs::write(&path, &bytes).unwrap();
    store.brick(NodeKey::ROOT).unwrap();
}

/// Reads everything in a store with these bytes, and returns how much of it is damaged.
fn read_all(bytes: Vec<u8>) -> u64 {
    let Ok(store) = Store::from_bytes(Path::new("damaged.lloom"), bytes) else { return 1 };
    let shape = store.shape();
    for node in (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth)) {
        let NodeSummary { min, max } = store.summary(node);
        assert!(min <= max && min.is_finite() && max.is_finite());
        let _ = (store.brick(node), store.cells(node));
    }
    store.verify(&|_, _| {}).damage_count
}

#[test]
fn every_changed_byte_is_found() {
    let folder = tempfile::tempdir().unwrap();
    for codec in [Codec::None, Codec::Lz4, Codec::Zstd] {
        let bytes = store_bytes(folder.path(), codec);
        assert_eq!(read_all(bytes.clone()), 0);
        // Header and table, each byte in turn, and then some of the bricks.
        let table = bytes.len() - 64 * 5;
        for at in (0..320).chain((320..table).step_by(bytes.len() / 150)).chain(table..bytes.len()) {
            for flip in [0x01, 0x80, 0xff] {
                let mut changed = bytes.clone();
                changed[at] ^= flip;
                assert!(read_all(changed) > 0, "byte {at} of {} with {codec:?}", bytes.len());
            }
        }
    }
}

#[test]
fn damage_of_a_brick_is_that_bricks_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = store_bytes(folder.path(), Codec::Lz4);
    let store = Store::from_bytes(Path::new("whole.lloom"), bytes.clone()).unwrap();
    let Table::Tree { start, .. } = store.table else { panic!("a new store has a tree") };
    let node = NodeKey { depth: 1, cell: UVec3::new(1, 0, 0) };
    // The first brick in the file, in its voxels.
    bytes[store.rules.bricks.0 as usize + 200] ^= 0x10;
    let damaged = Store::from_bytes(Path::new("damaged.lloom"), bytes.clone()).unwrap();
    let shape = store.shape();
    let all = || (0..=1).flat_map(|depth| shape.nodes(depth));
    let broken: Vec<_> = all().filter(|&node| damaged.brick(node).is_err()).collect();
    assert_eq!(broken.len(), 1);
    let BrickError { sentence: said, kind } = damaged.brick(broken[0]).unwrap_err();
    assert_eq!(kind, BrickErrorKind::Damaged);
    assert!(said.contains(&format!("brick {} of damaged.lloom is damaged", broken[0])), "{said}");
    assert!(all().all(|node| damaged.summary(node) == store.summary(node)));
    // An entry of the table: its bounds become those of the root.
    bytes[start as usize + 2 * 64 + 5] ^= 1;
    let damaged = Store::from_bytes(Path::new("damaged.lloom"), bytes).unwrap();
    let error = damaged.brick(node).unwrap_err();
    assert!(error.to_string().contains("entry 2 of the table"));
    assert_eq!(error.kind, BrickErrorKind::Damaged);
    assert_eq!(damaged.summary(node), store.summary(NodeKey::ROOT));
}

/// A file written once by the first program that wrote version 1: whoever changes the format changes the version.
#[test]
fn a_file_of_version_1_still_reads() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/version_1.lloom");
    let store = Store::open(Path::new(path)).unwrap();
    assert_eq!((store.shape().dims(), store.value_range()), (UVec3::new(5, 6, 4), (0.0, 354.0)));
    assert_eq!(
        (store.bits(), store.codec(), store.source_name()),
        (CodeBits::Eight, Codec::Lz4, "short.nrrd")
    );
    let brick = store.brick(NodeKey::ROOT).unwrap();
    for (x, y, z) in [(0, 0, 0), (4, 5, 3), (1, 2, 3)] {
        let error = brick.value(Brick::index(x + 2, y + 2, z + 2)) - (x + 10 * y + 100 * z) as f64;
        assert!(error.abs() <= 354.0 / 255.0 / 2.0 + 1e-3, "{error}");
    }
}

/// A file written once by the first program that wrote version 2: whoever changes the format changes the version.
#[test]
fn a_file_of_version_2_still_reads() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/version_2.lloom");
    let store = Store::open(Path::new(path)).unwrap();
    assert_eq!((store.version(), store.bits(), store.codec()), (2, CodeBits::Sixteen, Codec::Zstd));
    assert_eq!((store.listed_nodes(), store.stored_bricks(), store.has_deviation()), (33, 28, true));
    let found = store.verify(&|_, _| {});
    assert_eq!((found.bricks, found.damages), (28, vec![]));
    let vessels = ProceduralVolume::new("sparse-vessels", UVec3::splat(60), 1e-3).unwrap();
    for node in store.shape().nodes(2) {
        let (brick, truth) = (store.brick(node).unwrap(), vessels.brick(node).unwrap());
        let error = (0..BRICK_VOXELS).map(|i| (brick.value(i) - truth.value(i)).abs()).fold(0.0, f64::max);
        // Both have 16 bits of their own range, of the values 0 to 1.
        assert!(error <= 1.1 / 65535.0, "{node}: {error}");
    }
    assert!(store.brick(NodeKey::ROOT).unwrap().deviation.is_some_and(|deviation| deviation.step > 0.0));
}
