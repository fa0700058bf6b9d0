//! Hard cases of a build: numbers at the ends of f32, any number of threads, tables that lie with right checksums.

use super::build_tests::{Grid, build_in, check_all, check_errors, hashed, options};
use super::bytes::checksum;
use super::entry::{ENTRY_BYTES, Entry};
use super::*;
use crate::volume::{Element, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Squares of most of these are none of f32's.
#[test]
fn levels_are_right_at_any_scale() {
    let folder = tempfile::tempdir().unwrap();
    for scale in [1e20, 3e18, 1e-21, 1e-24, f64::from(f32::MAX)] {
        let value = |p| f64::from(((f64::from(hashed(p)) / 32767.5 - 1.0) * scale) as f32);
        let mut grid = Grid::new(UVec3::new(59, 31, 30), Element::F32, value);
        let options = BuildOptions { has_deviation: true, ..options(CodeBits::Eight, Codec::Lz4) };
        let (store, report) = build_in(folder.path(), &mut grid, &options);
        check_errors(&report.levels, &check_all(&store, &grid));
        assert_eq!(store.verify(&|_, _| {}).damages, Vec::<String>::new(), "{scale}");
        assert!(store.brick(NodeKey::ROOT).unwrap().deviation.is_some(), "{scale}");
    }
}

#[test]
fn the_ends_of_f32_stay_finite() {
    let folder = tempfile::tempdir().unwrap();
    for dims in [UVec3::new(59, 59, 31), UVec3::new(113, 7, 7), UVec3::new(3, 115, 3)] {
        for stripe in [1, 2, 4] {
            let value =
                |p: UVec3| f64::from(if (p.x / stripe).is_multiple_of(2) { f32::MAX } else { f32::MIN });
            let mut grid = Grid::new(dims, Element::F32, value);
            let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::Lz4));
            check_errors(&report.levels, &check_all(&store, &grid));
        }
    }
}

/// Sums of f64 depend on their order, and threads finish in any.
#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let value = |p| f64::from(hashed(p)) * 0.37 - 9.0;
            let mut grid = Grid::new(UVec3::new(11, 1901, 3), Element::F64, value);
            drop(build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::None)));
            std::fs::read(folder.path().join("grid.lloom")).unwrap()
        })
    };
    let one = bytes(1);
    assert!([2, 7, 16].into_iter().all(|threads| bytes(threads) == one));
}

#[test]
fn numbers_that_round_to_whole_ones_are_not_whole() {
    let folder = tempfile::tempdir().unwrap();
    let value = |p: UVec3| if p.x == 0 { -60000.0 } else { f64::from(0.0019f32) };
    let mut grid = Grid::new(UVec3::splat(4), Element::F32, value);
    let (store, _) = build_in(folder.path(), &mut grid, &options(CodeBits::Sixteen, Codec::Lz4));
    assert!(store.brick(NodeKey::ROOT).unwrap().step < 1.0);
}

/// A volume with a NaN in an early slab, which asks to stop while it is surveyed.
struct Endless {
    info: VolumeInfo,
    stop: Arc<AtomicBool>,
    read: AtomicU32,
}

impl VolumeReader for Endless {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        (0..slab.len()).for_each(|i| slab.set(i, if z == 5 && i == 0 { f64::NAN } else { f64::from(z) }));
        let read = self.read.fetch_add(1, Ordering::Relaxed);
        self.stop.fetch_or(read == 20, Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn a_build_stops_while_it_surveys() {
    let folder = tempfile::tempdir().unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let (dims, frame) = (UVec3::new(4, 4, 1000), VolumeFrame::of_voxels(DVec3::ONE));
    let info = VolumeInfo::unscaled("endless", dims, frame, Element::F32);
    let mut reader = Endless { info, stop: Arc::clone(&stop), read: AtomicU32::new(0) };
    let options = BuildOptions { stop: Some(stop), ..BuildOptions::default() };
    let error = build(&mut reader, &folder.path().join("a.lloom"), &options, &|_, _| {}).unwrap_err();
    assert!(error.to_string().contains("nothing was written"), "{error}");
    assert!(reader.read.load(Ordering::Relaxed) < 30);
}

#[test]
fn memory_that_cannot_do_is_said_before_it_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let (dims, frame) = (UVec3::new(1 << 20, 1 << 20, 1), VolumeFrame::of_voxels(DVec3::ONE));
    let info = VolumeInfo::unscaled("wide", dims, frame, Element::U8);
    let mut reader = Endless { info, stop: Arc::default(), read: AtomicU32::new(0) };
    let error = build(&mut reader, &folder.path().join("a.lloom"), &BuildOptions::default(), &|_, _| {});
    let said = error.unwrap_err().to_string();
    assert!(said.contains("MiB of memory") && said.contains("wide"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// The root's entry changed, with right checksums.
fn with_root(mut bytes: Vec<u8>, change: impl Fn(&mut Entry)) -> Vec<u8> {
    let place = u64::from_le_bytes(bytes[152..160].try_into().unwrap()) as usize;
    let mut entry = Entry::from_bytes(bytes[place..place + ENTRY_BYTES].try_into().unwrap()).unwrap();
    change(&mut entry);
    bytes[place..place + ENTRY_BYTES].copy_from_slice(&entry.to_bytes());
    bytes
}

/// As many voxels along x as said, with a right checksum.
fn with_width(mut bytes: Vec<u8>, width: u32) -> Vec<u8> {
    bytes[20..24].copy_from_slice(&width.to_le_bytes());
    bytes[12..16].fill(0);
    let sum = checksum(&bytes[..256]);
    bytes[12..16].copy_from_slice(&sum.to_le_bytes());
    bytes
}

#[test]
fn tables_that_lie_are_found_and_read_as_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = Grid::new(UVec3::splat(20), Element::U8, |p| f64::from(p.x % 5));
    build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::None));
    // One brick that claims to be the root of two.
    let bytes = with_width(std::fs::read(folder.path().join("grid.lloom")).unwrap(), 40);
    for (children, first_child) in [(0, 0), (3, 0), (3, 5), (3, u64::MAX), (1, 1), (0xff, 1)] {
        let lying =
            with_root(bytes.clone(), |root| (root.children, root.first_child) = (children, first_child));
        let store = Store::from_bytes(Path::new("lying.lloom"), lying).unwrap();
        assert!(store.verify(&|_, _| {}).damage_count > 0, "{children} {first_child}");
        for node in store.shape().nodes(1) {
            assert!(store.brick(node).is_err(), "{node} with {children} {first_child}");
            store.summary(node);
        }
    }
}
