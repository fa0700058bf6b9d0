//! Zarr folders that zarr-python wrote, read whole and in parts, and damaged ones.
//!
//! They hold value = x + 10 y + 100 z over 5 × 6 × 4 voxels where nothing else is said.

use crate::{Selection, open};
use bricks::volume::{Element, Samples, VolumeError, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use std::fs;
use std::path::{Path, PathBuf};

const DIMS: UVec3 = UVec3::new(5, 6, 4);
const MM: DVec3 = DVec3::new(0.5, 0.75, 2.0);

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/zarr").join(name)
}

fn values(reader: &mut dyn VolumeReader) -> Result<Vec<f64>, VolumeError> {
    let info = reader.info().clone();
    let mut slab = Samples::new(info.element, info.slab_voxels());
    let mut values = Vec::new();
    for z in 0..info.dims.z {
        reader.read_slab(z, &mut slab)?;
        values.extend((0..slab.len()).map(|i| slab.get(i)));
    }
    Ok(values)
}

fn read(path: &Path, selection: &Selection) -> Result<(VolumeInfo, Vec<f64>), VolumeError> {
    let mut reader = open(path, selection)?;
    Ok((reader.info().clone(), values(reader.as_mut())?))
}

fn expected(dims: UVec3, value: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
    let place = |i: u32| (i % dims.x, i / dims.x % dims.y, i / dims.x / dims.y);
    (0..dims.element_product()).map(place).map(|(x, y, z)| value(x.into(), y.into(), z.into())).collect()
}

fn ramp(x: f64, y: f64, z: f64) -> f64 {
    x + 10.0 * y + 100.0 * z
}

/// With memory for everything, and for one plane or chunk at a time.
fn check(name: &str, element: Element, value: impl Fn(f64, f64, f64) -> f64) {
    for memory_bytes in [1 << 20, 150, 0] {
        let selection = Selection { memory_bytes, ..Default::default() };
        let (info, values) = read(&data(name), &selection).unwrap();
        assert_eq!((info.dims, info.element, info.name.as_str()), (DIMS, element, name));
        assert_eq!(values, expected(DIMS, &value), "{name} in {memory_bytes} bytes");
    }
}

fn complaint(path: &Path, selection: &Selection) -> String {
    let said = read(path, selection).unwrap_err().to_string();
    assert!(said.contains(&*path.to_string_lossy()) && !said.contains('\n'), "{said}");
    said
}

#[test]
fn element_types() {
    for (name, element) in [
        ("u2", Element::U16),
        ("i2", Element::I16),
        ("u4", Element::U32),
        ("i4", Element::I32),
        ("u8", Element::U64),
        ("i8", Element::I64),
        ("f4", Element::F32),
        ("f8", Element::F64),
        ("f2", Element::F32),
    ] {
        check(&format!("type_{name}.zarr"), element, ramp);
    }
    check("type_u1.zarr", Element::U8, |x, y, z| x + 10.0 * y + 40.0 * z);
    check("type_i1.zarr", Element::I8, |x, y, z| x + 10.0 * y - 20.0 * z);
    check("big_v2_u2.zarr", Element::U16, ramp);
    check("big_v2_f8.zarr", Element::F64, ramp);
    check("big_v3.zarr", Element::I32, ramp);
}

#[test]
fn codecs_orders_and_shards() {
    for name in ["order_f_v2", "lz4_v2", "gzip_v2", "gzip_crc_v3", "transposed_v3", "sharded"] {
        check(&format!("{name}.zarr"), Element::I16, ramp);
    }
    check("bitshuffle_v3.zarr", Element::U16, ramp);
    let said = complaint(&data("lzma_v2.zarr"), &Selection::default());
    assert!(said.contains("lzma") && said.contains("write it again"), "{said}");
}

#[test]
fn chunks_that_are_not_there_hold_the_fill_value() {
    check("missing.zarr", Element::I16, |x, y, z| if z < 2.0 { -7.0 } else { ramp(x, y, z) });
}

#[test]
fn a_plane_is_one_slab() {
    let (info, values) = read(&data("plane.zarr"), &Selection::default()).unwrap();
    let dims = UVec3::new(5, 6, 1);
    assert_eq!((info.dims, info.frame.voxel_size_m()), (dims, DVec3::splat(1e-3)));
    assert_eq!(values, expected(dims, ramp));
}

#[test]
fn slabs_read_in_any_order() {
    for name in ["sharded.zarr", "lz4_v2.zarr", "xyz_05.zarr"] {
        let mut reader = open(&data(name), &Selection { memory_bytes: 100, ..Default::default() }).unwrap();
        let mut slab = Samples::new(reader.info().element, 30);
        for z in [2, 3, 0, 3, 1] {
            reader.read_slab(z, &mut slab).unwrap();
            assert_eq!(slab.get(7), ramp(2.0, 1.0, z.into()), "{name} slab {z}");
        }
    }
}

#[test]
fn image_04_has_channels_times_and_levels() {
    let path = data("image_04.zarr");
    let chosen = Selection { channel: Some(2), time: Some(1), ..Default::default() };
    let (info, values) = read(&path, &chosen).unwrap();
    assert_eq!(values, expected(DIMS, |x, y, z| ramp(x, y, z) + 4000.0));
    assert!((info.frame.voxel_size_m() * 1e3 - MM).abs().max_element() < 1e-9, "{:?}", info.frame);
    assert!((info.frame.origin_m - DVec3::X * 3e-6).length() < 1e-12, "{:?}", info.frame);
    let (info, values) = read(&path, &Selection { level: Some(1), ..chosen.clone() }).unwrap();
    let half = UVec3::new(3, 3, 2);
    assert_eq!(values, expected(half, |x, y, z| 2.0 * ramp(x, y, z) + 4000.0));
    assert!((info.frame.voxel_size_m() * 1e3 - 2.0 * MM).abs().max_element() < 1e-9, "{:?}", info.frame);
    // The level's own translation is scaled by the image's, and then moved with it.
    let origin_mm = DVec3::new(0.25 + 0.003, 0.375, 1.0);
    assert!((info.frame.origin_m * 1e3 - origin_mm).length() < 1e-9, "{:?}", info.frame);
    let spaced = Selection { spacing_mm: Some(DVec3::ONE), ..chosen.clone() };
    assert_eq!(open(&path, &spaced).unwrap().info().frame.voxel_size_m(), DVec3::splat(1e-3));

    let said = complaint(&path, &Selection { time: Some(0), ..Default::default() });
    assert!(said.contains("3 channels (bone, skin, air)"), "{said}");
    let said = complaint(&path, &Selection { channel: Some(0), ..Default::default() });
    assert!(said.contains("2 points in time") && said.contains("from 0 to 1"), "{said}");
    let said = complaint(&path, &Selection { channel: Some(3), ..chosen.clone() });
    assert!(said.contains("no number 3"), "{said}");
    let said = complaint(&path, &Selection { level: Some(2), ..chosen });
    assert!(said.contains("0 (2 × 3 × 4 × 6 × 5), 1 (2 × 3 × 2 × 3 × 3)"), "{said}");
}

#[test]
fn image_05_is_sharded_and_may_have_any_order_of_axes() {
    check("image_05.zarr", Element::U16, ramp);
    check("xyz_05.zarr", Element::U16, ramp);
    let frame = open(&data("xyz_05.zarr"), &Selection::default()).unwrap().info().frame;
    assert!((frame.voxel_size_m() * 1e3 - MM).abs().max_element() < 1e-9, "{frame:?}");
    let level = Selection { level: Some(1), ..Default::default() };
    let (info, values) = read(&data("image_05.zarr"), &level).unwrap();
    assert_eq!(values, expected(info.dims, |x, y, z| 2.0 * ramp(x, y, z)));
    assert!((info.frame.voxel_size_m() * 1e3 - 2.0 * MM).abs().max_element() < 1e-9);
}

#[test]
fn of_several_images_one_is_named() {
    check("one_series.zarr", Element::I16, ramp);
    let said = complaint(&data("series.zarr"), &Selection::default());
    assert!(said.contains("2 images, 0, 1") && said.contains("series.zarr/0"), "{said}");
    let second = Selection { series: Some("2".into()), ..Default::default() };
    assert_eq!(read(&data("series.zarr"), &second).unwrap().1, expected(DIMS, |x, y, z| ramp(x, y, z) + 1.0));
    let folder = copy("series.zarr/0");
    assert!(spoil(folder.path(), ".zattrs", |_| "{}".into()).contains("give one of its arrays, 0"));
    assert!(spoil(folder.path(), ".zattrs", |_| "{\"plate\": {}}".into()).contains("A/1/0"));
    assert!(complaint(&data(""), &Selection::default()).contains("folder"));
}

/// A copy of a folder of the tests' data.
fn copy(name: &str) -> tempfile::TempDir {
    fn copy_into(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap().flatten() {
            let target = to.join(entry.file_name());
            match entry.path().is_dir() {
                true => copy_into(&entry.path(), &target),
                false => drop(fs::copy(entry.path(), target).unwrap()),
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    copy_into(&data(name), folder.path());
    folder
}

fn spoil(folder: &Path, file: &str, change: impl FnOnce(String) -> String) -> String {
    let path = folder.join(file);
    fs::write(&path, change(fs::read_to_string(&path).unwrap())).unwrap();
    complaint(folder, &Selection::default())
}

#[test]
fn metadata_that_lie_are_a_sentence_and_take_no_memory() {
    let said = |file: &str, from: &str, to: &str| {
        let folder = copy(if file == "zarr.json" { "gzip_crc_v3.zarr" } else { "gzip_v2.zarr" });
        spoil(folder.path(), file, |text| {
            let squeezed: String = text.split_whitespace().collect();
            assert!(squeezed.contains(from), "{squeezed}");
            squeezed.replace(from, to)
        })
    };
    let shape = "\"shape\":[4,6,5]";
    let chunks = "\"chunk_shape\":[3,4,2]";
    assert!(said("zarr.json", shape, "\"shape\":[4,6,9999999999999]").contains("each must be from 1"));
    assert!(said("zarr.json", shape, "\"shape\":[4,0,5]").contains("each must be from 1"));
    assert!(said("zarr.json", shape, "\"shape\":[4,1000000,1000000]").contains("coarser level"));
    assert!(said("zarr.json", shape, "\"shape\":[4,6]").len() > 20);
    assert!(said("zarr.json", shape, "\"shape\":[-4,6,5]").contains("list of sizes"));
    assert!(
        said("zarr.json", chunks, "\"chunk_shape\":[9000000,9000000,9000000]").contains("smaller chunks")
    );
    let huge = format!("\"chunk_shape\":[{0},{0},{0}]", u64::MAX);
    assert!(said("zarr.json", chunks, &huge).contains("smaller chunks"));
    assert!(said("zarr.json", chunks, "\"chunk_shape\":[0,4,2]").len() > 20);
    assert!(said("zarr.json", "\"name\":\"gzip\"", "\"name\":\"squash\"").contains("squash"));
    assert!(said("zarr.json", "\"int16\"", "\"complex64\"").contains("complex64"));
    assert!(said("zarr.json", "\"int16\"", "\"string\"").len() > 20);
    assert!(said("zarr.json", "{", "").contains("not JSON"));
    assert!(said(".zarray", "\"<i2\"", "\"<M8[s]\"").contains("write it again"));
    assert!(said(".zarray", "\"gzip\"", "\"squash\"").contains("squash"));
    assert!(
        said(".zarray", "\"chunks\":[3,6,5]", "\"chunks\":[3000000000,60000,5]").contains("smaller chunks")
    );
}

#[test]
fn images_that_lie_are_a_sentence() {
    let said = |from: &str, to: &str| {
        let folder = copy("image_05.zarr");
        spoil(folder.path(), "zarr.json", |text| {
            let squeezed: String = text.split_whitespace().collect();
            assert!(squeezed.contains(from), "{squeezed}");
            squeezed.replace(from, to)
        })
    };
    assert!(said("a/full", "../../etc").contains("leads out of it"));
    assert!(said("a/full", "a/none").contains("a/none"));
    assert!(said("\"scale\":[1,2.0,0.75,0.5]", "\"scale\":[2.0,0.75,0.5]").contains("3 numbers for 4 axes"));
    assert!(said("\"scale\":[1,2.0,0.75,0.5]", "\"scale\":[1,2.0,0,0.5]").contains("voxel size"));
    assert!(said("\"scale\":[1,2.0,0.75,0.5]", "\"scale\":\"2\"").contains("lacks its list"));
    assert!(said("\"type\":\"scale\"", "\"type\":\"affine\"").contains("affine"));
    assert!(said("\"name\":\"z\"", "\"name\":\"y\"").contains("no axis twice"));
    assert!(said("\"datasets\":[", "\"other\":[").contains("datasets"));
}

/// Every file with voxels of a folder.
fn chunk_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path());
    let of = |path: PathBuf| if path.is_dir() { chunk_files(&path) } else { vec![path] };
    let is_chunk = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        !name.starts_with(".z") && name != "zarr.json"
    };
    entries.flat_map(of).filter(is_chunk).collect()
}

#[test]
fn damaged_chunks_are_a_sentence_or_plain_data() {
    let names = ["lz4_v2", "gzip_v2", "gzip_crc_v3", "transposed_v3", "sharded", "bitshuffle_v3", "type_u2"];
    for name in names.map(|name| format!("{name}.zarr")) {
        let folder = copy(&name);
        let path = chunk_files(folder.path()).remove(0);
        let whole = fs::read(&path).unwrap();
        let mut refused = 0;
        let lengths = (0..whole.len()).step_by(whole.len().div_ceil(20));
        let cut = lengths.map(|length| whole[..length].to_vec());
        let flipped = (0..whole.len()).map(|at| {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            bytes
        });
        for bytes in cut.chain(flipped) {
            fs::write(&path, bytes).unwrap();
            for memory_bytes in [1 << 20, 0] {
                if let Err(error) = read(folder.path(), &Selection { memory_bytes, ..Default::default() }) {
                    let said = error.to_string();
                    assert!(said.contains("chunk [") && said.contains("copy it again"), "{said}");
                    refused += 1;
                }
            }
        }
        assert!(refused >= 40, "{name}: only {refused}");
    }
}

#[test]
fn a_chunk_that_unpacks_to_too_much_is_refused() {
    use std::io::Write;
    let bomb = vec![0u8; 50 << 20];
    let gzip = |bytes: &[u8]| {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        packed.write_all(bytes).unwrap();
        packed.finish().unwrap()
    };
    let mut lie = zstd::bulk::compress(&bomb[..100], 1).unwrap();
    // A header that promises 2⁶² bytes: single segment, eight bytes of content size.
    lie.splice(4..6, [0xe0, 0, 0, 0, 0, 0, 0, 0, 0x40]);
    let bombs =
        [("gzip_v2", gzip(&bomb)), ("type_u2", zstd::bulk::compress(&bomb, 1).unwrap()), ("type_u2", lie)];
    for (name, bytes) in bombs {
        let folder = copy(&format!("{name}.zarr"));
        fs::write(chunk_files(folder.path()).remove(0), bytes).unwrap();
        let said = complaint(folder.path(), &Selection::default());
        assert!(said.contains("cannot be decoded"), "{said}");
    }
}

#[test]
fn of_several_images_in_one_group_one_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (array, from) in [("a", "type_u2.zarr"), ("b", "type_f4.zarr")] {
        fs::create_dir_all(at(array).join("c/0/0")).unwrap();
        for name in ["zarr.json", "c/0/0/0"] {
            fs::copy(data(from).join(name), at(array).join(name)).unwrap();
        }
    }
    let image = |name: &str| {
        format!(
            r#"{{ "name": "{name} image", "axes": ["z", "y", "x"], "datasets": [{{ "path": "{name}",
                "coordinateTransformations": [{{ "type": "scale", "scale": [1, 1, 1] }}] }}] }}"#
        )
    };
    let group = |images: &[String]| {
        let images = images.join(",");
        let json = format!(
            r#"{{ "zarr_format": 3, "node_type": "group", "attributes": {{ "ome": {{ "version": "0.5",
                "multiscales": [{images}] }} }} }}"#
        );
        fs::write(at("zarr.json"), json).unwrap();
    };
    group(&[image("a"), image("b")]);
    let said = complaint(folder.path(), &Selection::default());
    assert!(said.contains("2 images, 1 (a image), 2 (b image): choose one"), "{said}");
    let of = |series: &str| Selection { series: Some(series.into()), ..Default::default() };
    for (series, element) in
        [("1", Element::U16), ("a image", Element::U16), ("2", Element::F32), ("b image", Element::F32)]
    {
        assert_eq!(read(folder.path(), &of(series)).unwrap().0.element, element, "{series}");
    }
    assert!(complaint(folder.path(), &of("3")).contains("choose one"));
    group(&[image("b")]);
    assert_eq!(read(folder.path(), &Selection::default()).unwrap().0.element, Element::F32);
    assert!(complaint(folder.path(), &of("c image")).contains("1 images"));
}
