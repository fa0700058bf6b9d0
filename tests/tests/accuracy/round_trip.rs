//! Every volume of the test data, all written by other programs, through a store and back.

use bricks::store::{BuildOptions, CodeBits, Codec, Store};
use bricks::volume::{Element, Samples, VolumeInfo};
use bricks::{BrickSource, NodeKey};
use glam::UVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use volumes::{ImportOptions, import};
use volumes::{Selection, open};

/// Rounding of f32, in which codes turn into values: values, and one rounding of each operation.
const ROUNDING: f64 = 4.0 / (1u64 << 24) as f64;
/// With 8 bits codes are taken in f32, which may push a value 1/10000 code beyond the half.
const HALF_A_CODE: f64 = 0.5001;

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data")
}

/// The volumes: files and folders; what cannot be opened in any way is no volume on its own, or meant to be refused.
fn volumes() -> Vec<(PathBuf, Selection)> {
    let mut found = Vec::new();
    for folder in [data(), data().join("dicom"), data().join("tiff"), data().join("zarr")] {
        let entries = std::fs::read_dir(&folder).expect("the test data are there");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("a folder can be listed").path()).collect();
        paths.sort();
        let in_root = folder == data();
        paths.retain(|path| !(in_root && path.is_dir()) && path.extension().is_none_or(|e| e != "py"));
        found.extend(paths.into_iter().filter_map(|path| choice(&path).map(|chosen| (path, chosen))));
    }
    found
}

/// A choice among what a path holds that opens it.
fn choice(path: &Path) -> Option<Selection> {
    let ones = [None, Some(0)];
    let choices = ones.into_iter().flat_map(|channel| ones.map(|time| (channel, time)));
    let choices = choices.flat_map(|(channel, time)| {
        [None, Some("1".to_owned())].map(|series| Selection { series, channel, time, ..Selection::default() })
    });
    choices.into_iter().find(|chosen| open(path, chosen).is_ok())
}

/// All voxels as the reader gives them.
fn voxels(path: &Path, chosen: &Selection) -> (VolumeInfo, Vec<f64>) {
    let mut reader = open(path, chosen).expect("it was opened before");
    let info = reader.info().clone();
    let mut slab = Samples::new(info.element, info.slab_voxels());
    let mut values = Vec::new();
    for z in 0..info.dims.z {
        reader.read_slab(z, &mut slab).unwrap_or_else(|error| panic!("{error}"));
        values.extend((0..slab.len()).map(|i| info.value(slab.get(i))));
    }
    (info, values)
}

/// Largest error of a store in codes of each brick's range, beyond the rounding of f32, and largest error at all.
fn errors(store: &Store, values: &[f64]) -> (f64, f64) {
    let shape = store.shape();
    let dims = shape.dims();
    let (mut codes, mut largest) = (0.0f64, 0.0f64);
    for node in shape.nodes(shape.finest_depth()) {
        let brick = store.brick(node).expect("a store just built is whole");
        let size = (dims - node.cell * 28).min(UVec3::splat(28));
        for place in (0..size.element_product())
            .map(|i| UVec3::new(i % size.x, i / size.x % size.y, i / size.x / size.y))
        {
            let voxel = node.cell * 28 + place;
            let source = values[((voxel.z * dims.y + voxel.y) * dims.x + voxel.x) as usize];
            // What is not finite is replaced, which is another test's.
            if (source as f32).is_finite() {
                let stored = brick.value((((place.z + 2) * 32 + place.y + 2) * 32 + place.x + 2) as usize);
                let error = (stored - source).abs();
                largest = largest.max(error);
                let beyond = (error - ROUNDING * source.abs()).max(0.0);
                let is_uniform_and_wrong = brick.step == 0.0 && beyond > 0.0;
                let of_step = if brick.step > 0.0 { beyond / f64::from(brick.step) } else { 0.0 };
                codes = codes.max(if is_uniform_and_wrong { f64::INFINITY } else { of_step });
            }
        }
    }
    (codes, largest)
}

fn build(path: &Path, chosen: &Selection, bits: CodeBits, out: &Path) -> Store {
    let build = BuildOptions { bits, codec: Codec::Zstd, ..Default::default() };
    let options = ImportOptions { build, ..Default::default() };
    import(path, chosen, out, &options, &|_, _| {}).unwrap_or_else(|error| panic!("{error}"));
    Store::open(out).expect("a store just built opens")
}

fn is_kept_exactly(info: &VolumeInfo) -> bool {
    info.is_unscaled() && matches!(info.element, Element::U8 | Element::I8 | Element::U16 | Element::I16)
}

#[test]
fn every_volume_of_other_programs_survives_a_store() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let out = folder.path().join("a.lloom");
    let mut elements: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let (mut count, mut worst) = (0, 0.0f64);
    for (path, chosen) in volumes() {
        let (info, values) = voxels(&path, &chosen);
        for bits in [CodeBits::Eight, CodeBits::Sixteen] {
            let store = build(&path, &chosen, bits, &out);
            assert_eq!((store.shape().dims(), store.frame()), (info.dims, info.frame), "{}", path.display());
            assert!(store.verify(&|_, _| {}).damages.is_empty(), "{}", path.display());
            let (codes, largest) = errors(&store, &values);
            assert!(codes <= HALF_A_CODE, "{}: {codes} codes with {bits:?}", path.display());
            if bits == CodeBits::Sixteen && is_kept_exactly(&info) {
                assert!(largest == 0.0, "{}: {largest}", path.display());
            }
            assert!(store.summary(NodeKey::ROOT).min <= store.summary(NodeKey::ROOT).max);
            worst = worst.max(codes);
        }
        let format = kind(&path);
        elements.entry(format).or_default().insert(info.element.to_string());
        count += 1;
    }
    println!("{count} volumes; largest error {worst:.6} codes\n{elements:#?}");
    for (format, types) in
        [("nrrd", 10), ("nifti", 10), ("metaimage", 10), ("zarr", 10), ("tiff", 8), ("dicom", 4)]
    {
        assert!(elements[format].len() >= types, "{format}: {:?}", elements[format]);
    }
    assert!(count > 130, "only {count} volumes were found");
}

fn kind(path: &Path) -> String {
    let text = path.to_string_lossy();
    let ends = |endings: &[&str]| endings.iter().any(|ending| text.ends_with(ending));
    let kind = if text.contains("/dicom/") {
        "dicom"
    } else if text.contains("/tiff/") {
        "tiff"
    } else if text.contains("/zarr/") {
        "zarr"
    } else if ends(&[".nrrd", ".nhdr"]) {
        "nrrd"
    } else if ends(&[".mha", ".mhd"]) {
        "metaimage"
    } else {
        "nifti"
    };
    kind.to_owned()
}
