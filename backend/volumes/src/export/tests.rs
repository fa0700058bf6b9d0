//! What is exported reads back as the store has it.

use super::*;
use crate::{ImportOptions, import};
use crate::{Selection, open};
use bricks::store::Store;
use bricks::volume::{Element, MAX_EDGE_VOXELS};
use bricks::volume::{Samples, Space, VolumeFrame, VolumeInfo};
use bricks::{BRICK_VOXELS, Brick, BrickError, Codes, NodeKey, NodeSummary, OctreeShape};
use glam::UVec3;
use glam::{DMat3, DVec3};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// A volume whose bricks are made as they are asked for: value = x + 2 y + 3 z + `low` at the finest level, and the
/// same by its own indices times `step` at coarser ones.
struct Grid {
    shape: OctreeShape,
    frame: VolumeFrame,
    low: f32,
    step: f32,
    damaged: Option<NodeKey>,
}

impl Grid {
    fn new(dims: UVec3) -> Self {
        let frame = VolumeFrame::of_voxels(DVec3::new(1e-3, 2e-3, 4e-3));
        Self { shape: OctreeShape::new(dims), frame, low: 0.0, step: 1.0, damaged: None }
    }

    fn value(&self, depth: u8, p: UVec3) -> f64 {
        let step = if depth == self.shape.finest_depth() { 1.0 } else { self.step };
        f64::from(self.low) + f64::from(p.x + 2 * p.y + 3 * p.z) * f64::from(step)
    }

    fn expected(&self, part: &Part) -> Vec<f64> {
        let n = part.size;
        let place = |i: u32| part.low + UVec3::new(i % n.x, i / n.x % n.y, i / n.x / n.y);
        (0..n.element_product()).map(|i| self.value(part.depth, place(i))).collect()
    }
}

impl BrickSource for Grid {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> VolumeFrame {
        self.frame
    }

    fn value_range(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    fn summary(&self, _: NodeKey) -> NodeSummary {
        NodeSummary { min: 0.0, max: 1.0 }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        assert!(self.shape.contains(node), "{node:?}");
        if self.damaged == Some(node) {
            return Err(BrickError::damaged("brick 7 of a.lloom is damaged"));
        }
        let last = self.shape.level_dims(node.depth).as_ivec3() - 1;
        let code = |i: usize| {
            let ijk = glam::IVec3::new(i as i32 % 32, i as i32 / 32 % 32, i as i32 / 1024);
            let p = (node.cell.as_ivec3() * 28 + ijk - 2).clamp(glam::IVec3::ZERO, last).as_uvec3();
            (p.x + 2 * p.y + 3 * p.z) as u16
        };
        let step = if node.depth == self.shape.finest_depth() { 1.0 } else { self.step };
        Ok(Brick::new(Codes::U16((0..BRICK_VOXELS).map(code).collect()), self.low, step))
    }
}

fn read(path: &Path, selection: &Selection) -> (VolumeInfo, Vec<f64>) {
    let mut reader = open(path, selection).unwrap();
    let info = reader.info().clone();
    let mut slab = Samples::new(info.element, info.slab_voxels());
    let mut values = Vec::new();
    for z in 0..info.dims.z {
        reader.read_slab(z, &mut slab).unwrap();
        values.extend((0..slab.len()).map(|i| slab.get(i)));
    }
    (info, values)
}

fn of_level(level: u32) -> Selection {
    Selection { level: Some(level), ..Default::default() }
}

fn quietly(
    source: &dyn BrickSource,
    out: &Path,
    options: &ExportOptions,
) -> Result<ExportReport, ExportError> {
    export(source, out, options, &|_, _| {})
}

fn supply_of(source: &dyn BrickSource) -> Supply<'_> {
    Supply { source, out: Path::new("a"), stop: None }
}

#[test]
fn nrrd_of_any_part_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let grid = Grid { low: -3.0, ..Grid::new(UVec3::new(61, 30, 59)) };
    let all = ExportOptions::default();
    let inner = (Some(UVec3::new(27, 1, 28)), Some(UVec3::new(30, 29, 1)));
    for (name, options, element) in [
        ("whole", all.clone(), Element::I16),
        ("packed", ExportOptions { is_packed: true, ..all.clone() }, Element::I16),
        ("float", ExportOptions { element: Some(Element::F64), ..all.clone() }, Element::F64),
        ("coarse", ExportOptions { level: Some(1), ..all.clone() }, Element::I16),
        ("part", ExportOptions { low: inner.0, size: inner.1, ..all.clone() }, Element::U8),
        ("rest", ExportOptions { low: inner.0, ..all }, Element::I16),
    ] {
        let path = folder.path().join(name).with_extension("nrrd");
        let report = quietly(&grid, &path, &options).unwrap();
        let part = grid::part(&grid, &options).unwrap();
        let (info, values) = read(&path, &Selection::default());
        assert_eq!((info.dims, info.element, report.element), (part.size, element, element), "{name}");
        assert_eq!(values, grid.expected(&part), "{name}");
        assert_eq!(report.bytes, path.metadata().unwrap().len());
        let size = grid::frame(&grid, &part).voxel_size_m();
        assert!((info.frame.voxel_size_m() - size).abs().max_element() < 1e-12, "{name}");
    }
}

#[test]
fn zarr_has_all_levels_or_one() {
    let folder = tempfile::tempdir().unwrap();
    let frame = VolumeFrame {
        origin_m: DVec3::new(0.1, 0.2, 0.3),
        ..VolumeFrame::of_voxels(DVec3::new(1e-3, 2e-3, 4e-3))
    };
    let grid = Grid { frame, ..Grid::new(UVec3::new(130, 29, 70)) };
    let path = folder.path().join("all.zarr");
    let report = quietly(&grid, &path, &ExportOptions::default()).unwrap();
    assert_eq!((report.levels.len(), report.element), (4, Element::I16));
    for (level, part) in grid::all_levels(&grid).iter().enumerate() {
        let (info, values) = read(&path, &of_level(level as u32));
        assert_eq!(values, grid.expected(part), "level {level}");
        let expected = grid::frame(&grid, part);
        assert!((info.frame.origin_m - expected.origin_m).length() < 1e-12, "{:?}", info.frame);
        assert!((info.frame.voxel_size_m() - expected.voxel_size_m()).length() < 1e-12, "{:?}", info.frame);
    }
    let path = folder.path().join("part.zarr");
    let low = Some(UVec3::new(65, 0, 0));
    let options = ExportOptions { low, level: Some(0), ..Default::default() };
    quietly(&grid, &path, &options).unwrap();
    let part = grid::part(&grid, &options).unwrap();
    assert_eq!(read(&path, &of_level(0)).1, grid.expected(&part));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn the_smallest_type_that_keeps_the_values_is_chosen() {
    let of = |low: f32, step: f32, dims: UVec3| {
        let grid = Grid { low, step, ..Grid::new(dims) };
        numbers::smallest_element(supply_of(&grid), &grid::all_levels(&grid)).unwrap()
    };
    let small = UVec3::splat(40);
    assert_eq!(of(0.0, 1.0, small), Element::U8);
    assert_eq!(of(-1.0, 1.0, small), Element::I16);
    assert_eq!(of(40_000.0, 1.0, small), Element::U16);
    assert_eq!(of(-40_000.0, 1.0, small), Element::I32);
    assert_eq!(of(0.5, 1.0, small), Element::F32);
    assert_eq!(of(0.0, 0.5, small), Element::F32);
    assert_eq!(of(3e9, 1.0, small), Element::F32);
}

#[test]
fn frames_follow_the_level_and_the_part() {
    let axes_m = DMat3::from_cols(DVec3::Y * 2e-3, DVec3::X * 1e-3, DVec3::Z * -3e-3);
    let frame = VolumeFrame { axes_m, origin_m: DVec3::new(0.01, -0.02, 0.5), space: Space::Patient };
    let grid = Grid { frame, ..Grid::new(UVec3::splat(60)) };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.nrrd");
    let low = Some(UVec3::new(1, 0, 2));
    quietly(&grid, &path, &ExportOptions { level: Some(1), low, ..Default::default() }).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let end = bytes.windows(2).position(|pair| pair == b"\n\n").unwrap();
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    assert!(header.contains("space: left-posterior-superior\n"), "{header}");
    assert!(header.contains("space directions: (0,4,0) (2,0,0) (0,0,-6)\n"), "{header}");
    // Half a finest voxel along each axis, then one coarse voxel along the first and two along the third.
    assert!(header.contains("space origin: (10.5,-15,486.5"), "{header}");
    let report = quietly(&grid, &folder.path().join("a.zarr"), &ExportOptions::default()).unwrap();
    assert!(report.has_lost_directions);
    let info = read(&folder.path().join("a.zarr"), &of_level(1)).0;
    assert!((info.frame.origin_m * 1e3 - DVec3::new(1.0, 0.5, 1.5)).length() < 1e-9, "{:?}", info.frame);
}

#[test]
fn what_cannot_be_done_is_said_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let grid = Grid::new(UVec3::splat(60));
    let said = |source: &Grid, name: &str, options: &ExportOptions| {
        quietly(source, &folder.path().join(name), options).unwrap_err().to_string()
    };
    let all = ExportOptions::default();
    assert!(said(&grid, "a.tif", &all).contains(".nrrd or .zarr"));
    assert!(said(&grid, "none/a.nrrd", &all).contains("none/a.nrrd"));
    assert!(said(&grid, "none/a.zarr", &all).contains("none/a.zarr"));
    let level = ExportOptions { level: Some(9), ..all.clone() };
    assert!(said(&grid, "a.nrrd", &level).contains("0 (60 × 60 × 60), 1 (30 × 30 × 30)"));
    for (low, size) in [((0, 0, 1), (60, 60, 60)), ((60, 0, 0), (1, 1, 1)), ((0, 0, 0), (0, 1, 1))] {
        let options = ExportOptions { low: Some(low.into()), size: Some(size.into()), ..all.clone() };
        assert!(said(&grid, "a.nrrd", &options).contains("60 × 60 × 60 voxels"));
    }
    let huge = ExportOptions { low: Some(UVec3::MAX), size: Some(UVec3::MAX), ..all.clone() };
    assert!(said(&grid, "a.zarr", &huge).contains("are asked for"));
    let bytes = ExportOptions { element: Some(Element::U8), ..all.clone() };
    assert!(said(&grid, "a.nrrd", &bytes).contains("does not fit into uint8"));
    let node = NodeKey { depth: grid.shape.finest_depth(), cell: UVec3::new(1, 0, 2) };
    let damaged = Grid { damaged: Some(node), ..Grid::new(UVec3::splat(60)) };
    for name in ["a.nrrd", "a.zarr"] {
        let options = ExportOptions { element: Some(Element::F32), ..all.clone() };
        assert!(said(&damaged, name, &options).contains("brick 7 of a.lloom"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    for name in ["b.nrrd", "b.zarr"] {
        quietly(&grid, &folder.path().join(name), &all).unwrap();
        assert!(said(&grid, name, &all).contains("is there already"));
    }
}

#[test]
fn a_store_comes_back_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("short.lloom");
    let data = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data").join(name);
    let imported = |input: PathBuf| {
        let (selection, options) = (Selection::default(), ImportOptions::default());
        import(&input, &selection, &store, &options, &|_, _| {}).unwrap();
        Store::open(&store).unwrap()
    };
    let opened = imported(data("zarr/sharded.zarr"));
    let node = NodeKey { depth: opened.shape().finest_depth(), cell: UVec3::ZERO };
    let brick = opened.brick(node).unwrap();
    let index = |i: usize| Brick::index(i % 5 + 2, i / 5 % 6 + 2, i / 30 + 2);
    let in_store: Vec<f64> = (0..120).map(|i| f64::from(brick.value(index(i)) as f32)).collect();
    for name in ["again.nrrd", "again.zarr"] {
        let again = folder.path().join(name);
        quietly(&opened, &again, &ExportOptions::default()).unwrap();
        let (info, values) = read(&again, &Selection::default());
        assert_eq!((info.dims, values), (UVec3::new(5, 6, 4), in_store.clone()), "{name}");
    }
}

/// A volume of one value, as large as can be, which asks to stop once so many bricks have been read.
struct Endless {
    stop: Arc<AtomicBool>,
    read: AtomicU32,
}

const READ_BEFORE_STOP: u32 = 1000;

impl BrickSource for Endless {
    fn shape(&self) -> OctreeShape {
        OctreeShape::new(UVec3::splat(MAX_EDGE_VOXELS))
    }

    fn frame(&self) -> VolumeFrame {
        VolumeFrame::of_voxels(DVec3::splat(1e-3))
    }

    fn value_range(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn summary(&self, _: NodeKey) -> NodeSummary {
        NodeSummary { min: 0.0, max: 0.0 }
    }

    fn brick(&self, _: NodeKey) -> Result<Brick, BrickError> {
        if self.read.fetch_add(1, Ordering::Relaxed) == READ_BEFORE_STOP {
            self.stop.store(true, Ordering::Relaxed);
        }
        Ok(Brick::new(Codes::U8(vec![0; BRICK_VOXELS]), 0.0, 0.0))
    }
}

#[test]
fn no_claim_takes_memory_and_any_export_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    for (name, element) in [("a.zarr", None), ("a.zarr", Some(Element::F64)), ("b.nrrd", Some(Element::U8))] {
        let stop = Arc::new(AtomicBool::new(false));
        let source = Endless { stop: stop.clone(), read: AtomicU32::new(0) };
        let options = ExportOptions { element, stop: Some(stop), ..Default::default() };
        let error = quietly(&source, &folder.path().join(name), &options).unwrap_err().to_string();
        match name {
            "a.zarr" => assert!(error.starts_with("stopped: nothing was written"), "{error}"),
            _ => assert!(error.contains("1048576 × 1048576 voxels is too large"), "{error}"),
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
    }
    for name in ["a.nrrd", "a.zarr"] {
        let stop = Arc::new(AtomicBool::new(false));
        let source = Endless { stop: stop.clone(), read: AtomicU32::new(0) };
        let (size, low) = (Some(UVec3::new(3000, 2000, 90)), Some(UVec3::new(5, 70, 0)));
        let options = ExportOptions { size, low, level: Some(0), stop: Some(stop), ..Default::default() };
        let error = quietly(&source, &folder.path().join(name), &options).unwrap_err().to_string();
        assert!(error.starts_with("stopped: nothing was written"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
    }
}

/// Killed, an export leaves its working files, which the next one to the same name takes over.
#[test]
fn what_a_killed_export_left_is_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at(".a.nrrd.part"), "left over").unwrap();
    std::fs::write(at(".a.zarr.part"), "").unwrap();
    std::fs::create_dir_all(at(".a.zarr.folder/0/c")).unwrap();
    let grid = Grid::new(UVec3::splat(5));
    for name in ["a.nrrd", "a.zarr"] {
        quietly(&grid, &at(name), &ExportOptions::default()).unwrap();
        assert_eq!(read(&at(name), &Selection::default()).0.dims, UVec3::splat(5));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}
