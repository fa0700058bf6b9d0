//! The readers against files that other programs wrote (SimpleITK, nibabel, pynrrd) and against damaged ones.
//!
//! Most files hold value = x + 10 y + 100 z over 5 × 6 × 4 voxels of 0.5 × 0.75 × 2 mm.

use super::*;
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::{DVec3, UVec3};
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const DIMS: UVec3 = UVec3::new(5, 6, 4);
pub(super) const VOXEL_SIZE_M: DVec3 = DVec3::new(0.5e-3, 0.75e-3, 2e-3);

pub(super) fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name)
}

pub(super) fn values(reader: &mut dyn VolumeReader) -> Result<Vec<f64>, VolumeError> {
    let slab_voxels = reader.info().slab_voxels();
    let info = reader.info().clone();
    let mut slab = Samples::new(info.element, slab_voxels);
    let mut values = Vec::new();
    for z in 0..info.dims.z {
        reader.read_slab(z, &mut slab)?;
        values.extend((0..slab_voxels).map(|i| info.value(slab.get(i))));
    }
    Ok(values)
}

/// The values, but none of a volume that is far larger than those of the tests: a header that lies.
pub(super) fn some_values(reader: &mut dyn VolumeReader) -> Result<Vec<f64>, VolumeError> {
    if reader.info().voxels() > 1 << 14 { Ok(Vec::new()) } else { values(reader) }
}

pub(super) fn expected(dims: UVec3, value: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
    let place = |i: u32| (i % dims.x, i / dims.x % dims.y, i / dims.x / dims.y);
    (0..dims.element_product()).map(place).map(|(x, y, z)| value(x.into(), y.into(), z.into())).collect()
}

pub(super) fn ramp(x: f64, y: f64, z: f64) -> f64 {
    x + 10.0 * y + 100.0 * z
}

fn check(name: &str, element: Element, value: impl Fn(f64, f64, f64) -> f64) {
    let mut reader = open(&data(name), &Selection::default()).unwrap();
    let info = reader.info().clone();
    assert_eq!((info.dims, info.element), (DIMS, element), "{name}");
    assert!(
        (info.frame.voxel_size_m() - VOXEL_SIZE_M).abs().max_element() < 1e-9,
        "{name}: {:?}",
        info.frame
    );
    assert_eq!(values(reader.as_mut()).unwrap(), expected(DIMS, value), "{name}");
}

#[test]
fn nrrd() {
    check("short.nrrd", Element::I16, ramp);
    check("ushort_gzip.nrrd", Element::U16, ramp);
    check("float.nhdr", Element::F32, ramp);
    check("big_directions.nrrd", Element::I16, ramp);
    check("spacings_gzip.nhdr", Element::F64, ramp);
    check("char.nrrd", Element::I8, |x, y, z| x + 10.0 * y - 20.0 * z);
}

#[test]
fn metaimage() {
    check("short.mhd", Element::I16, ramp);
    check("ushort_zlib.mha", Element::U16, ramp);
    check("double.mha", Element::F64, ramp);
}

#[test]
fn nifti() {
    check("ushort.nii", Element::U16, ramp);
    check("short_big.nii.gz", Element::I16, ramp);
    check("float_metres.nii", Element::F32, ramp);
    check("uint_sitk.nii.gz", Element::U32, ramp);
    check("scaled.nii", Element::I16, ramp);
}

fn raw_layout() -> RawLayout {
    RawLayout {
        dims: DIMS,
        element: Element::U16,
        byte_order: ByteOrder::Big,
        spacing_mm: VOXEL_SIZE_M * 1e3,
        header_skip_bytes: 0,
    }
}

fn of_raw(raw: RawLayout) -> Selection {
    Selection { raw: Some(raw), ..Default::default() }
}

#[test]
fn raw() {
    let path = data("ushort_big.raw");
    assert_eq!(values(open(&path, &of_raw(raw_layout())).unwrap().as_mut()).unwrap(), expected(DIMS, ramp));
    let without_first_slab = RawLayout { header_skip_bytes: 60, dims: UVec3::new(5, 6, 3), ..raw_layout() };
    let rest = values(open(&path, &of_raw(without_first_slab)).unwrap().as_mut()).unwrap();
    assert_eq!(rest, expected(DIMS, ramp)[30..]);
}

#[test]
fn slabs_read_in_any_order() {
    for name in ["short.mhd", "ushort_gzip.nrrd", "short_big.nii.gz"] {
        let mut reader = open(&data(name), &Selection::default()).unwrap();
        let mut slab = Samples::new(reader.info().element, 30);
        for z in [2, 3, 0, 3, 1] {
            reader.read_slab(z, &mut slab).unwrap();
            assert_eq!(slab.get(7), ramp(2.0, 1.0, z.into()), "{name} slab {z}");
        }
    }
}

#[test]
fn an_unknown_extension_is_told_by_its_first_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["short.nrrd", "double.mha", "ushort.nii", "short_big.nii.gz"] {
        let copy = folder.path().join("volume.dat");
        std::fs::copy(data(name), &copy).unwrap();
        assert_eq!(
            values(open(&copy, &Selection::default()).unwrap().as_mut()).unwrap(),
            expected(DIMS, ramp),
            "{name}"
        );
    }
}

/// What is said of a file with these bytes.
fn complaint(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let error = open(&path, &Selection::default())
        .and_then(|mut reader| values(reader.as_mut()).map(|_| ()))
        .unwrap_err();
    let said = error.to_string();
    assert!(said.contains(&*folder.path().to_string_lossy()) && !said.contains('\n'), "{said}");
    said
}

#[test]
fn files_cut_short_at_any_place_are_an_error() {
    for name in
        ["short.nrrd", "ushort_gzip.nrrd", "ushort_zlib.mha", "double.mha", "ushort.nii", "short_big.nii.gz"]
    {
        let bytes = std::fs::read(data(name)).unwrap();
        // The last 18 bytes of a packed file are checksums and end marks, which need not be there.
        for length in (0..bytes.len() - 18).step_by(7) {
            complaint(name, &bytes[..length]);
        }
    }
}

#[test]
fn headers_that_lie_are_found_out_before_memory_is_taken() {
    let header =
        |sizes: &str, rest: &str| format!("NRRD0004\ntype: short\ndimension: 3\nsizes: {sizes}\n{rest}\n\n");
    let raw = "endian: little\nencoding: raw";
    let said = |sizes, rest| complaint("lie.nrrd", header(sizes, rest).as_bytes());
    assert!(said("1000000 1000000 1000000", raw).contains("too short"));
    assert!(said("1000000 1000000 1", "endian: big\nencoding: gzip").contains("too short"));
    assert!(said("4294967295 4294967295 4294967295", raw).contains("each must be from 1"));
    assert!(said("0 1 1", raw).contains("each must be from 1"));
    assert!(said("5 6", raw).contains("three numbers"));
    assert!(said("5 -6 4", raw).contains("number expected"));
    assert!(said("5 6 4", "encoding: raw").contains("endian: little"));
    assert!(said("5 6 4", "endian: little\nencoding: hex").contains("raw or gzip"));
    assert!(said("5 6 4", "endian: little\nencoding: raw\nspacings: 1 0 1").contains("voxel size"));
    assert!(complaint("block.nrrd", b"NRRD0004\ntype: block\ndimension: 3\n\n").contains("block"));
    assert!(complaint("no.nrrd", b"PNG").contains("line 1"));
}

#[test]
fn nifti_headers_that_lie() {
    let bytes = std::fs::read(data("ushort.nii")).unwrap();
    let with = |at: usize, value: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        complaint("lie.nii", &bytes)
    };
    assert!(with(0, &540i32.to_le_bytes()).contains("NIfTI-2"));
    assert!(with(0, &1i32.to_le_bytes()).contains("starts with 348"));
    assert!(with(42, &32767i16.to_le_bytes()).contains("too short"));
    assert!(with(42, &(-1i16).to_le_bytes()).contains("at least 1"));
    assert!(with(40, &9i16.to_le_bytes()).contains("axes"));
    assert!(with(70, &128i16.to_le_bytes()).contains("data type 128"));
    assert!(with(108, &f32::NAN.to_le_bytes()).contains("start at byte"));
    assert!(with(108, &1e8f32.to_le_bytes()).contains("too short"));
    assert!(with(80, &f32::NAN.to_le_bytes()).contains("voxel size"));
}

#[test]
fn a_small_gzip_file_cannot_promise_a_large_volume() {
    let mut bytes = std::fs::read(data("ushort.nii")).unwrap();
    for at in [42, 44, 46] {
        bytes[at..at + 2].copy_from_slice(&2000i16.to_le_bytes());
    }
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(&bytes).unwrap();
    assert!(complaint("lie.nii.gz", &packed.finish().unwrap()).contains("packed bytes cannot hold"));
}

#[test]
fn what_cannot_be_read_is_said_in_a_sentence() {
    assert!(complaint("picture.gif", b"GIF89a").contains("is not known"));
    assert!(complaint("empty.nii", b"").contains("348 bytes"));
    let missing = open(Path::new("/nowhere/head.nii"), &Selection::default()).unwrap_err().to_string();
    assert!(missing.contains("/nowhere/head.nii") && missing.contains("check the path"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    assert!(open(folder.path(), &Selection::default()).unwrap_err().to_string().contains("folder"));
    let wrong = RawLayout { dims: UVec3::splat(u32::MAX), ..raw_layout() };
    assert!(open(&data("ushort_big.raw"), &of_raw(wrong)).unwrap_err().to_string().contains("after the 0"));
    let wrong = RawLayout { element: Element::U8, ..raw_layout() };
    assert!(open(&data("ushort_big.raw"), &of_raw(wrong)).unwrap_err().to_string().contains("240 bytes"));
}
