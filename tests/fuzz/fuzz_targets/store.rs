//! Reads a hostile store: all that can be asked of it, with right checksums or wrong ones.
#![no_main]

use bricks::store::Store;
use bricks::{BRICK_VOXELS, Brick, BrickSource, Codes, NodeKey, NodeSummary};
use glam::UVec3;
use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use lightloom_fuzz::resign::{Repair, resign};
use std::path::Path;
use volumes::export::{ExportOptions, export};

/// Nodes read of each depth; a small table can be that of an octree of any size.
const NODES_PER_DEPTH: usize = 24;
/// Memory beside what grows with the file: a brick is read, unpacked, decoded and its cells made anew to compare, each
/// at most 32³ × 2 bytes and two such bricks at a time; headers, and 100 sentences of damage.
const CONSTANT_BYTES: usize = 1 << 20;
/// Memory per byte of the file: an entry of 64 (version 1: 32) bytes is kept decoded (88 bytes), listed for the check
/// (120 bytes, twice while the list grows), with its node (20 bytes) and its extent (40 bytes, sorted).
const BYTES_PER_BYTE: usize = 16;
/// Memory of an export beside that: a row of bricks as numbers, and what packs them.
const EXPORT_BYTES: usize = 64 << 20;
/// Voxels along each axis of what is exported of a volume.
const PART: u32 = 8;
/// Volumes of no more voxels are exported whole.
const SMALL: u64 = 1 << 15;

fuzz_target!(|data: &[u8]| {
    let Some((&control, bytes)) = data.split_first() else { return };
    let mut bytes = bytes.to_vec();
    resign(&mut bytes, repair(control));
    let most = CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len();
    let budget = Budget::new(most);
    let Ok(store) = Store::from_bytes(Path::new("input.lloom"), bytes) else { return };
    read(&store);
    drop(budget);
    let _budget = Budget::new(most + EXPORT_BYTES);
    export_some(&store, control);
});

/// The last voxels of a level, and a small volume whole.
fn export_some(store: &Store, control: u8) {
    let Ok(folder) = tempfile::tempdir() else { return };
    let shape = store.shape();
    let level = control % (shape.finest_depth() + 1);
    let dims = shape.level_dims(shape.finest_depth() - level);
    let size = dims.min(UVec3::splat(PART));
    let part =
        ExportOptions { level: Some(level), low: Some(dims - size), size: Some(size), ..Default::default() };
    let name = if control & 0x20 == 0 { "a.nrrd" } else { "a.zarr" };
    let _ = export(store, &folder.path().join(name), &part, &|_, _| {});
    if shape.dims().as_u64vec3().element_product() <= SMALL {
        let _ = export(store, &folder.path().join(format!("whole-{name}")), &Default::default(), &|_, _| {});
    }
}

/// Mostly everything is put right; a quarter of all inputs keeps what is wrong, each bit one part of it.
fn repair(control: u8) -> Repair {
    let is_right = |bit: u8| control & 0xc0 != 0xc0 || control >> bit & 1 == 0;
    Repair {
        table: is_right(0),
        places: is_right(1),
        extents: is_right(2),
        entries: is_right(3),
        header: is_right(4),
    }
}

fn read(store: &Store) {
    let _ = (format!("{store:?}"), store.level_errors(), store.frame(), store.stored_bricks());
    let shape = store.shape();
    for depth in 0..=shape.finest_depth() {
        let last = NodeKey { depth, cell: shape.level_bricks(depth) - 1 };
        shape.nodes(depth).take(NODES_PER_DEPTH).chain([last]).for_each(|node| read_node(store, node));
    }
    let found = store.verify(&|_, _| {});
    assert!(found.damages.len() as u64 <= found.damage_count);
}

fn read_node(store: &Store, node: NodeKey) {
    let NodeSummary { min, max } = store.summary(node);
    assert!(min <= max && min.is_finite() && max.is_finite(), "{node}: {min} to {max}");
    let _ = store.cells(node);
    if let Ok(Brick { codes, low, step, deviation, .. }) = store.brick(node) {
        let count = match &codes {
            Codes::U8(codes) => codes.len(),
            Codes::U16(codes) => codes.len(),
        };
        assert_eq!(count, BRICK_VOXELS);
        assert!(deviation.is_none_or(|deviation| deviation.codes.len() == BRICK_VOXELS));
        assert!(low.is_finite() && step.is_finite() && step >= 0.0);
    }
}
