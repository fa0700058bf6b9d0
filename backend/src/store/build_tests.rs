//! Laws of the build: what is built reads back, coarser levels are means, bounds bound.

use super::*;
use crate::volume::{Element, Samples, Selection, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::Path;

/// A volume in memory.
pub(super) struct Grid {
    info: VolumeInfo,
    values: Vec<f64>,
}

impl Grid {
    pub fn new(dims: UVec3, element: Element, value: impl Fn(UVec3) -> f64) -> Self {
        let place = |i| UVec3::new(i % dims.x, i / dims.x % dims.y, i / dims.x / dims.y);
        let values = (0..dims.element_product()).map(place).map(value).collect();
        let frame = VolumeFrame::of_voxels(DVec3::new(1e-3, 1e-3, 2e-3));
        let info = VolumeInfo { name: "grid".into(), dims, frame, element, slope: 1.0, intercept: 0.0 };
        Self { info, values }
    }

    fn at(&self, p: UVec3) -> f64 {
        let dims = self.info.dims;
        self.values[((p.z * dims.y + p.y) * dims.x + p.x) as usize]
    }

    /// The next coarser level, written from its definition.
    fn halved(&self) -> Self {
        let dims = self.info.dims;
        Self::new(dims.map(|n| n.div_ceil(2)), Element::F64, |p| {
            let corners = (0..8).map(|i| p * 2 + UVec3::new(i & 1, (i >> 1) & 1, i >> 2));
            let values: Vec<_> = corners.filter(|q| q.cmplt(dims).all()).map(|q| self.at(q)).collect();
            values.iter().sum::<f64>() / values.len() as f64
        })
    }
}

impl VolumeReader for Grid {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        let start = z as usize * slab.len();
        for (i, value) in self.values[start..start + slab.len()].iter().enumerate() {
            slab.set(i, *value);
        }
        Ok(())
    }
}

fn hashed(p: UVec3) -> u32 {
    let mixed = p.x.wrapping_mul(0x9e37_79b9) ^ p.y.wrapping_mul(0x85eb_ca6b) ^ p.z.wrapping_mul(0xc2b2_ae35);
    (mixed ^ (mixed >> 15)).wrapping_mul(0x2c1b_3c6d) >> 16
}

pub(super) fn options(bits: CodeBits, codec: Codec) -> BuildOptions {
    BuildOptions { bits, codec, ..Default::default() }
}

pub(super) fn build_in(folder: &Path, grid: &mut Grid, options: &BuildOptions) -> (Store, BuildReport) {
    let path = folder.join("grid.lloom");
    let report = build(grid, &path, options, &|_, _| {}).unwrap();
    (Store::open(&path).unwrap(), report)
}

/// Every stored sample of every node against the levels computed from their definition; returns the largest error at
/// the finest level.
fn check_all(store: &Store, grid: &Grid) -> f64 {
    let shape = store.shape();
    let mut level = Grid { info: grid.info.clone(), values: grid.values.clone() };
    let mut finest_error = 0.0f64;
    for depth in (0..=shape.finest_depth()).rev() {
        assert_eq!(level.info.dims, shape.level_dims(depth));
        for node in shape.nodes(depth) {
            let brick = store.brick(node).unwrap();
            let error = check_brick(&brick, &level, node);
            if depth == shape.finest_depth() {
                finest_error = finest_error.max(error);
            }
            check_bounds(store, &brick, node);
        }
        level = level.halved();
    }
    finest_error
}

/// The definition in [`Brick`]'s documentation, sample for sample; returns the largest error.
fn check_brick(brick: &Brick, level: &Grid, node: NodeKey) -> f64 {
    let last = level.info.dims.as_ivec3() - 1;
    let mut largest = 0.0f64;
    for (index, ijk) in
        (0..BRICK_VOXELS as i32).map(|i| (i as usize, glam::IVec3::new(i % 32, i / 32 % 32, i / 1024)))
    {
        let voxel = (node.cell.as_ivec3() * 28 + ijk - 2).clamp(glam::IVec3::ZERO, last);
        let error = (brick.value(index) - level.at(voxel.as_uvec3())).abs();
        // Half a step, the step's rounding, and that of means kept as f32.
        let allowed = f64::from(brick.step) * 0.51 + 1e-6 * level.at(voxel.as_uvec3()).abs();
        assert!(error <= allowed, "{node:?} {ijk}: error {error}, step {}", brick.step);
        largest = largest.max(error);
    }
    largest
}

fn check_bounds(store: &Store, brick: &Brick, node: NodeKey) {
    let mut above = Some(node);
    while let Some(key) = above {
        let NodeSummary { min, max } = store.summary(key);
        let inside = |value: f64| f64::from(min) <= value && value <= f64::from(max);
        assert!((0..BRICK_VOXELS).all(|index| inside(brick.value(index))), "{node:?} in {key:?}");
        above = key.parent();
    }
}

#[test]
fn every_sample_of_every_level_is_right() {
    let folder = tempfile::tempdir().unwrap();
    for dims in
        [UVec3::new(61, 30, 59), UVec3::ONE, UVec3::new(1, 1, 90), UVec3::new(29, 57, 2), UVec3::splat(28)]
    {
        let mut grid =
            Grid::new(dims, Element::F32, |p| f64::from(hashed(p)) as f32 as f64 * 0.37f32 as f64 - 9.0);
        grid.values.iter_mut().for_each(|value| *value = f64::from(*value as f32));
        for (bits, codec) in [(CodeBits::Eight, Codec::Lz4), (CodeBits::Sixteen, Codec::None)] {
            let (store, report) = build_in(folder.path(), &mut grid, &options(bits, codec));
            check_all(&store, &grid);
            assert_eq!((store.shape().dims(), store.voxel_size_m()), (dims, grid.info.frame.voxel_size_m()));
            assert_eq!(store.value_range(), report.value_range);
            assert_eq!((report.non_finite, store.source_name()), (0, "grid"));
        }
    }
}

#[test]
fn sixteen_bits_keep_sixteen_bit_integers() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = Grid::new(UVec3::new(40, 33, 50), Element::I16, |p| f64::from(hashed(p)) - 32768.0);
    let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Sixteen, Codec::Lz4));
    assert_eq!(check_all(&store, &grid), 0.0);
    assert_eq!((report.max_error, report.rms_error), (0.0, 0.0));
}

#[test]
fn the_reported_error_is_the_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = Grid::new(UVec3::splat(28), Element::I16, |p| f64::from(hashed(p)));
    let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::None));
    let brick = store.brick(NodeKey::ROOT).unwrap();
    let places = (0..28u32.pow(3)).map(|i| UVec3::new(i % 28, i / 28 % 28, i / 784));
    let errors: Vec<_> = places
        .map(|p| brick.value(Brick::index(p.x as usize + 2, p.y as usize + 2, p.z as usize + 2)) - grid.at(p))
        .collect();
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    assert_eq!(report.max_error, errors.iter().fold(0.0, |max: f64, error| max.max(error.abs())));
    assert!((report.rms_error - rms).abs() < 1e-9 && rms > 50.0, "{} and {rms}", report.rms_error);
}

#[test]
fn constant_bricks_take_no_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid =
        Grid::new(UVec3::splat(80), Element::U8, |p| if p == UVec3::splat(70) { 9.0 } else { 3.0 });
    let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::None));
    assert_eq!((report.nodes, report.stored_bricks), (27 + 8 + 1, 1 + 1 + 1));
    assert_eq!(check_all(&store, &grid), 0.0);
}

#[test]
fn what_is_not_finite_is_replaced_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = Grid::new(UVec3::new(31, 3, 40), Element::F32, |p| f64::from(p.x));
    for (place, value) in [(3, f64::NAN), (9, f64::INFINITY), (31 * 7, f64::NEG_INFINITY), (31 * 9, 1e300)] {
        grid.values[place] = value;
    }
    let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Sixteen, Codec::Lz4));
    assert_eq!((report.non_finite, report.value_range), (4, (0.0, 30.0)));
    for (place, value) in [(3, 0.0), (9, 30.0), (31 * 7, 0.0), (31 * 9, 30.0)] {
        grid.values[place] = value;
    }
    check_all(&store, &grid);
    grid.values.fill(f64::NAN);
    let error =
        build(&mut grid, &folder.path().join("nan.lloom"), &BuildOptions::default(), &|_, _| {}).unwrap_err();
    assert!(error.to_string().contains("no finite value"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left of a failed build");
}

#[test]
fn little_memory_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = Grid::new(UVec3::new(50, 33, 64), Element::U16, |p| f64::from(hashed(p)));
    let bytes = |grid: &mut Grid, memory_bytes| {
        let options = BuildOptions { memory_bytes, ..BuildOptions::default() };
        drop(build_in(folder.path(), grid, &options));
        std::fs::read(folder.path().join("grid.lloom")).unwrap()
    };
    assert!(bytes(&mut grid, 0) == bytes(&mut grid, 1 << 30));
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let mut grid = Grid::new(UVec3::ONE, Element::U8, |_| 0.0);
    let error =
        build(&mut grid, Path::new("/nowhere/x.lloom"), &BuildOptions::default(), &|_, _| {}).unwrap_err();
    assert!(error.to_string().starts_with("cannot write /nowhere/x.lloom"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let error = build(&mut grid, folder.path(), &BuildOptions::default(), &|_, _| {}).unwrap_err();
    assert!(error.to_string().contains("directory"), "{error}");
}

#[test]
fn a_procedural_volume_is_imported() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("shells.lloom");
    let options = ImportOptions { procedural_dims: UVec3::new(40, 30, 20), ..Default::default() };
    let told = std::cell::Cell::new((0, 0));
    let report = import("procedural:shells", &Selection::default(), &out, &options, &|done, total| {
        told.set((done, total))
    })
    .unwrap();
    assert_eq!(told.get(), (20, 20));
    assert_eq!(Store::open(&out).unwrap().shape().dims(), report.dims);
    let error = import("procedural:shell", &Selection::default(), &out, &options, &|_, _| {}).unwrap_err();
    assert!(error.to_string().contains("sparse-vessels"));
    let itself = out.to_string_lossy().into_owned();
    assert!(
        import(&itself, &Selection::default(), &out, &options, &|_, _| {})
            .unwrap_err()
            .to_string()
            .contains("replace")
    );
}

#[test]
fn a_real_file_with_nan_is_imported() {
    let folder = tempfile::tempdir().unwrap();
    let input = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/non_finite.nrrd");
    let report = import(
        input,
        &Selection::default(),
        &folder.path().join("a.lloom"),
        &ImportOptions::default(),
        &|_, _| {},
    )
    .unwrap();
    assert_eq!((report.non_finite, report.value_range), (3, (1.0, 353.0)));
}
