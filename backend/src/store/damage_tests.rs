//! Damaged and hostile stores: each is an error in words, none a panic.

use super::build_tests::{Grid, build_in, options};
use super::*;
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
        said.contains("version 7") && said.contains("reads version 1") && said.contains("import"),
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
fn hostile_bytes_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    for codec in [Codec::None, Codec::Lz4] {
        let bytes = store_bytes(folder.path(), codec);
        // Header, name and table, each byte in turn, and then some of the bricks.
        for at in (0..160 + 32 * 5).chain((320..bytes.len()).step_by(bytes.len() / 50)) {
            for value in [0x00, 0x7f, 0x80, 0xff] {
                let mut hostile = bytes.clone();
                hostile[at] = value;
                complaint(folder.path(), &hostile);
            }
        }
        let entry_offset = 160 + 16;
        let mut hostile = bytes.clone();
        hostile[entry_offset..entry_offset + 8].copy_from_slice(&(u64::MAX - 3).to_le_bytes());
        assert!(complaint(folder.path(), &hostile).unwrap().contains("outside the file"));
    }
}

/// A file written once by the first program that wrote version 1: whoever changes the format changes the version.
#[test]
fn a_file_of_version_1_still_reads() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/version_1.lloom");
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
