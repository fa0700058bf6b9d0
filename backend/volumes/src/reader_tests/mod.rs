//! The readers against files that other programs wrote (SimpleITK, nibabel, pynrrd) and against damaged ones.
//!
//! Most files hold value = x + 10 y + 100 z over 5 × 6 × 4 voxels of 0.5 × 0.75 × 2 mm.

mod choices;
mod damage;
mod lies;
mod metaimage;
mod nifti;
mod nrrd;

use super::*;
use bricks::volume::{ByteOrder, Element, Samples, Space, VolumeError, VolumeFrame, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::{Path, PathBuf};

pub(super) const DIMS: UVec3 = UVec3::new(5, 6, 4);
pub(super) const VOXEL_SIZE_M: DVec3 = DVec3::new(0.5e-3, 0.75e-3, 2e-3);

pub(super) fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data").join(name)
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

/// The ramp of the tests' volumes of unsigned bytes, which cannot hold [`ramp`].
fn low_ramp(x: f64, y: f64, z: f64) -> f64 {
    x + 10.0 * y + 40.0 * z
}

/// The ramp of the tests' volumes of signed bytes.
fn falling_ramp(x: f64, y: f64, z: f64) -> f64 {
    x + 10.0 * y - 20.0 * z
}

fn check(name: &str, element: Element, value: impl Fn(f64, f64, f64) -> f64) {
    check_chosen(name, &Selection::default(), element, value);
}

fn chosen(channel: Option<u32>, time: Option<u32>) -> Selection {
    Selection { channel, time, ..Selection::default() }
}

fn check_chosen(name: &str, selection: &Selection, element: Element, value: impl Fn(f64, f64, f64) -> f64) {
    let mut reader = open(&data(name), selection).unwrap();
    let info = reader.info().clone();
    assert_eq!((info.dims, info.element), (DIMS, element), "{name}");
    assert!(
        (info.frame.voxel_size_m() - VOXEL_SIZE_M).abs().max_element() < 1e-9,
        "{name}: {:?}",
        info.frame
    );
    assert_eq!(values(reader.as_mut()).unwrap(), expected(DIMS, value), "{name}");
}

/// What is said where one of several volumes is not chosen, or one that is not there.
fn refusal(name: &str, selection: &Selection) -> String {
    open(&data(name), selection).unwrap_err().to_string()
}

/// Largest error of a place that the file says in double precision, mm.
const EXACT_MM: f64 = 1e-9;
/// Largest error of a place that the file says in single precision, mm: some rounding errors of 33 mm.
const SINGLE_MM: f64 = 1e-5;

/// Whether the centres of voxels (0, 0, 0) and (4, 5, 3) are where another program says, mm.
fn check_places(name: &str, space: Space, places_mm: [[f64; 3]; 2], error_mm: f64) {
    let frame = open(&data(name), &Selection::default()).unwrap().info().frame;
    assert_eq!(frame.space, space, "{name}");
    for (voxel, place_mm) in [DVec3::ZERO, DVec3::new(4.0, 5.0, 3.0)].into_iter().zip(places_mm) {
        let found_mm = (frame.origin_m + frame.axes_m * voxel) * 1e3;
        let error = (found_mm - DVec3::from_array(place_mm)).length();
        assert!(error < error_mm, "{name}: voxel {voxel} at {found_mm} mm");
    }
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
    for name in ["short.mhd", "ushort_gzip.nrrd", "short_big.nii.gz", "list.nhdr", "text.mha"] {
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

#[test]
fn another_voxel_size_keeps_the_directions() {
    let of_file = open(&data("oblique.nrrd"), &Selection::default()).unwrap().info().frame;
    let selection = Selection { spacing_mm: Some(DVec3::splat(3.0)), ..Default::default() };
    let frame = open(&data("oblique.nrrd"), &selection).unwrap().info().frame;
    assert!((frame.voxel_size_m() - 3e-3).abs().max_element() < 1e-12);
    assert!(frame.directions().abs_diff_eq(of_file.directions(), 1e-12));
    assert_eq!((frame.origin_m, frame.space), (of_file.origin_m, of_file.space));
}
