//! Laws of the build: what is built reads back, coarser levels are means, bounds bound.

use super::*;
use crate::volume::{Element, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
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
        let info = VolumeInfo::unscaled("grid", dims, frame, element);
        Self { info, values }
    }

    fn at(&self, p: UVec3) -> f64 {
        let dims = self.info.dims;
        self.values[((p.z * dims.y + p.y) * dims.x + p.x) as usize]
    }

    /// A level, written from its definition: means of the voxels of the source in cubes of an edge.
    fn level(&self, edge: u32) -> Self {
        let dims = self.info.dims;
        Self::new(dims.map(|n| n.div_ceil(edge)), Element::F64, |p| {
            let covered = self.covered(p, edge);
            covered.iter().sum::<f64>() / covered.len() as f64
        })
    }

    /// The source's values in a cube.
    fn covered(&self, p: UVec3, edge: u32) -> Vec<f64> {
        let (low, high) = (p * edge, (p * edge + edge).min(self.info.dims));
        let rows = (low.z..high.z).flat_map(|z| (low.y..high.y).map(move |y| (y, z)));
        rows.flat_map(|(y, z)| (low.x..high.x).map(move |x| UVec3::new(x, y, z)))
            .map(|p| self.at(p))
            .collect()
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

pub(super) fn hashed(p: UVec3) -> u32 {
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

/// Every stored sample of every node against the levels computed from their definition; returns the errors of the
/// levels against the source, finest first.
pub(super) fn check_all(store: &Store, grid: &Grid) -> Vec<LevelError> {
    let shape = store.shape();
    let mut errors = Vec::new();
    for depth in (0..=shape.finest_depth()).rev() {
        let edge = 1 << shape.level(depth);
        let level = grid.level(edge);
        assert_eq!(level.info.dims, shape.level_dims(depth));
        let (mut max, mut squares) = (0.0f64, 0.0);
        for node in shape.nodes(depth) {
            let brick = store.brick(node).unwrap();
            check_brick(&brick, &level, node);
            check_bounds(store, &brick, node);
            assert!(
                brick.cells.as_ref().is_some_and(|cells| *cells == CellRanges::of(&brick.codes)),
                "{node}"
            );
            assert_eq!(store.cells(node).unwrap(), brick.cells);
            check_deviation(&brick, grid, node, edge);
            for error in source_errors(&brick, grid, node, edge) {
                max = max.max(error.abs());
                squares += error * error;
            }
        }
        errors.push(LevelError { rms: (squares / grid.values.len() as f64).sqrt(), max });
    }
    errors
}

/// The own voxels of a node inside the level, and where they are stored.
fn own(level: UVec3, node: NodeKey) -> impl Iterator<Item = (UVec3, usize)> {
    let places = (0..28u32.pow(3)).map(|i| UVec3::new(i % 28, i / 28 % 28, i / 784));
    let stored = |p: UVec3| Brick::index(p.x as usize + 2, p.y as usize + 2, p.z as usize + 2);
    places.map(move |p| (node.cell * 28 + p, stored(p))).filter(move |(p, _)| p.cmplt(level).all())
}

/// Differences of a node's own voxels to every voxel of the source in them.
fn source_errors(brick: &Brick, grid: &Grid, node: NodeKey, edge: u32) -> Vec<f64> {
    let dims = grid.info.dims.map(|n| n.div_ceil(edge));
    let of_voxel = |(p, index): (UVec3, usize)| {
        let value = brick.value(index);
        grid.covered(p, edge).into_iter().map(move |source| source - value)
    };
    own(dims, node).flat_map(of_voxel).collect()
}

fn check_deviation(brick: &Brick, grid: &Grid, node: NodeKey, edge: u32) {
    let Some(deviation) = &brick.deviation else { return };
    for (p, index) in own(grid.info.dims.map(|n| n.div_ceil(edge)), node) {
        let covered = grid.covered(p, edge);
        let mean = covered.iter().sum::<f64>() / covered.len() as f64;
        let variance = covered.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / covered.len() as f64;
        let kept = f64::from(deviation.codes[index]) * f64::from(deviation.step);
        // Half a code, and the rounding of every voxel to f32, which the deviation of a coarse one takes over.
        let rounding = mean.abs() * f64::from(f32::EPSILON);
        let allowed = f64::from(deviation.step) * 0.51 + rounding;
        assert!((kept - variance.sqrt()).abs() <= allowed, "{node} {p}: {kept}");
    }
}

/// The errors that a build reported against those found: it takes 8-bit differences in f32, whose rounding is up to
/// 255 codes × 2⁻²⁴ = 3e-5 of half a code.
pub(super) fn check_errors(reported: &[LevelError], found: &[LevelError]) {
    assert_eq!(reported.len(), found.len());
    for (reported, found) in reported.iter().zip(found) {
        assert!((reported.rms - found.rms).abs() <= 4e-5 * found.rms, "{reported:?} and {found:?}");
        assert!((reported.max - found.max).abs() <= 4e-5 * found.max, "{reported:?} and {found:?}");
    }
}

/// The definition in [`Brick`]'s documentation, sample for sample.
fn check_brick(brick: &Brick, level: &Grid, node: NodeKey) {
    let last = level.info.dims.as_ivec3() - 1;
    for (index, ijk) in
        (0..BRICK_VOXELS as i32).map(|i| (i as usize, glam::IVec3::new(i % 32, i / 32 % 32, i / 1024)))
    {
        let voxel = (node.cell.as_ivec3() * 28 + ijk - 2).clamp(glam::IVec3::ZERO, last);
        let error = (brick.value(index) - level.at(voxel.as_uvec3())).abs();
        // Half a step, the step's rounding, and that of means kept as f32.
        let allowed = f64::from(brick.step) * 0.51 + 1e-6 * level.at(voxel.as_uvec3()).abs();
        assert!(error <= allowed, "{node:?} {ijk}: error {error}, step {}", brick.step);
    }
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
        let value = |p| f64::from((f64::from(hashed(p)) * 0.37 - 9.0) as f32);
        let mut grid = Grid::new(dims, Element::F32, value);
        for (bits, codec) in
            [(CodeBits::Eight, Codec::Lz4), (CodeBits::Sixteen, Codec::None), (CodeBits::Eight, Codec::Zstd)]
        {
            let has_deviation = codec != Codec::Lz4;
            let options = BuildOptions { has_deviation, ..options(bits, codec) };
            let (store, report) = build_in(folder.path(), &mut grid, &options);
            check_errors(&report.levels, &check_all(&store, &grid));
            assert_eq!(store.level_errors(), report.levels);
            assert_eq!((store.shape().dims(), store.frame()), (dims, grid.info.frame));
            assert_eq!(store.value_range(), report.value_range);
            assert_eq!((report.non_finite, store.source_name()), (0, "grid"));
            let root = store.brick(NodeKey::ROOT).unwrap();
            assert_eq!(root.deviation.is_some(), has_deviation && dims.max_element() > 28, "{dims}");
            check_whole(&folder.path().join("grid.lloom"));
        }
    }
}

fn check_whole(path: &Path) {
    let found = verify(path, &|_, _| {}).unwrap();
    assert_eq!((found.damages, found.bytes), (vec![], std::fs::metadata(path).unwrap().len()));
}

#[test]
fn sixteen_bits_keep_sixteen_bit_integers() {
    let folder = tempfile::tempdir().unwrap();
    for (element, shift) in [(Element::I16, -32768.0), (Element::U16, 0.0)] {
        let mut grid = Grid::new(UVec3::new(40, 33, 50), element, |p| f64::from(hashed(p)) + shift);
        let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Sixteen, Codec::Lz4));
        assert_eq!(check_all(&store, &grid)[0], LevelError::default());
        assert_eq!((report.max_error, report.rms_error), (0.0, 0.0));
    }
}

/// Value = slope × stored + intercept, whatever the stored type; what f32 does not hold counts as error.
#[test]
fn every_element_type_is_kept_to_half_a_code() {
    let folder = tempfile::tempdir().unwrap();
    let elements = [
        (Element::U8, 255.0),
        (Element::I8, -128.0),
        (Element::U16, 65535.0),
        (Element::I16, -32768.0),
        (Element::U32, 4e9),
        (Element::I32, -2e9),
        (Element::U64, 1e12),
        (Element::I64, -1e12),
        (Element::F32, 1e-3),
        (Element::F64, 1e3),
    ];
    for (element, most) in elements {
        for (slope, intercept) in [(1.0, 0.0), (0.5, -1024.0)] {
            let stored = |p| {
                let value = most * f64::from(hashed(p)) / 65535.0;
                if element.is_float() { f64::from(value as f32) } else { value.trunc() }
            };
            let mut grid = Grid::new(UVec3::new(33, 20, 30), element, stored);
            (grid.info.slope, grid.info.intercept) = (slope, intercept);
            let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::Lz4));
            grid.values.iter_mut().for_each(|value| *value = *value * slope + intercept);
            let errors = check_all(&store, &grid);
            let range = report.value_range.1 - report.value_range.0;
            // Half of the widest brick's code, the whole range being the widest there can be; and f32.
            assert!(errors[0].max <= range / 510.0 * 1.001 + report.value_range.1.abs() * 1e-6, "{element}");
            assert!(
                errors[0].max <= report.max_error * 1.00004 && report.max_error > 0.0 || range <= 255.0,
                "{element}"
            );
        }
    }
}

#[test]
fn constant_bricks_take_no_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid =
        Grid::new(UVec3::splat(80), Element::U8, |p| if p == UVec3::splat(70) { 9.0 } else { 3.0 });
    let (store, report) = build_in(folder.path(), &mut grid, &options(CodeBits::Eight, Codec::None));
    assert_eq!((report.nodes, report.stored_bricks), (27 + 8 + 1, 1 + 1 + 1));
    assert_eq!(
        (store.listed_nodes(), store.stored_bricks()),
        (1 + 8 + 1, 3),
        "constant subtrees are listed once"
    );
    assert_eq!(check_all(&store, &grid)[0], LevelError::default());
    check_whole(&folder.path().join("grid.lloom"));
}

#[test]
fn bricks_that_nothing_shows_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    // Two columns of bricks, with their overlap, are below 100; the third begins to be more.
    let value = |p: UVec3| if p.x < 58 { f64::from(hashed(p) % 100) } else { 500.0 + f64::from(p.y) };
    let mut grid = Grid::new(UVec3::new(90, 40, 30), Element::U16, value);
    let emptiness = Emptiness::Below(100.0);
    let options = BuildOptions { emptiness, ..options(CodeBits::Sixteen, Codec::Lz4) };
    let (store, report) = build_in(folder.path(), &mut grid, &options);
    assert_eq!(report.emptied_bricks, 2 * 2 * 2);
    let node = NodeKey { depth: store.shape().finest_depth(), cell: UVec3::ZERO };
    let (brick, summary) = (store.brick(node).unwrap(), store.summary(node));
    assert_eq!((brick.step, store.stored_bytes(node)), (0.0, 0));
    assert_eq!((summary.min, summary.max), (brick.low, brick.low));
    let kept = NodeKey { cell: UVec3::new(2, 0, 0), ..node };
    assert!(store.stored_bytes(kept) > 0 && store.summary(kept).max > 500.0);
    assert_eq!((report.max_error, report.rms_error > 40.0), (99.0, true), "what was left out counts");
    check_whole(&folder.path().join("grid.lloom"));
}

#[test]
fn a_build_that_is_stopped_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let stop = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let options = BuildOptions { stop: Some(stop.clone()), ..BuildOptions::default() };
    let mut grid = Grid::new(UVec3::splat(60), Element::U16, |p| f64::from(hashed(p)));
    let at_slab = |done, _| stop.store(done == 40, std::sync::atomic::Ordering::Relaxed);
    let error = build(&mut grid, &folder.path().join("a.lloom"), &options, &at_slab).unwrap_err();
    assert!(error.to_string().starts_with("stopped: nothing was written"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
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
    let mut huge = Grid::new(UVec3::new(31, 3, 40), Element::F64, |p| 1e300 * f64::from(p.x + 1));
    let error = build(&mut huge, &folder.path().join("huge.lloom"), &BuildOptions::default(), &|_, _| {})
        .unwrap_err();
    assert!(error.to_string().contains("no value within 3.40e38"), "{error}");
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

#[cfg(unix)]
#[test]
fn a_link_to_a_store_stays_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("elsewhere")).unwrap();
    std::os::unix::fs::symlink("elsewhere/a.lloom", at("link.lloom")).unwrap();
    let mut grid = Grid::new(UVec3::splat(3), Element::U8, |p| f64::from(p.x));
    // First the link leads nowhere, then to the store of before.
    for _ in 0..2 {
        build(&mut grid, &at("link.lloom"), &BuildOptions::default(), &|_, _| {}).unwrap();
        assert!(at("link.lloom").symlink_metadata().unwrap().is_symlink());
        Store::open(&at("elsewhere/a.lloom")).unwrap();
        assert_eq!(std::fs::read_dir(at("elsewhere")).unwrap().count(), 1);
    }
}
