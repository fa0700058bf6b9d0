//! The DICOM reader against files that SimpleITK and pydicom wrote, and against damaged ones.

use crate::reader_tests::{data, expected, ramp, some_values, values};
use crate::{Selection, open};
use bricks::volume::{Element, Modality, Samples, Space, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::{Path, PathBuf};

const SLICE: UVec3 = UVec3::new(5, 6, 1);

fn file(name: &str) -> PathBuf {
    data("dicom").join(name)
}

fn opened(name: &str) -> Box<dyn VolumeReader> {
    open(&file(name), &Selection::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn of_slices(slices: u32) -> UVec3 {
    UVec3::new(5, 6, slices)
}

fn complaint(name: &str, selection: &Selection) -> String {
    let said = open(&file(name), selection).and_then(|mut reader| values(reader.as_mut()));
    let said = said.unwrap_err().to_string();
    assert!(said.contains(name) && !said.contains('\n'), "{said}");
    said
}

fn said_of(name: &str) -> String {
    complaint(name, &Selection::default())
}

#[test]
fn slices_lie_in_order_of_their_place_in_the_patient() {
    let mut reader = opened("oblique");
    let info = reader.info().clone();
    assert_eq!((info.dims, info.element, info.name.as_str()), (of_slices(4), Element::I16, "Oblique"));
    assert_eq!(values(reader.as_mut()).unwrap(), expected(of_slices(4), |x, y, z| ramp(x, y, z) - 50.0));
    assert_eq!(info.frame.space, Space::Patient);
    // What SimpleITK says of the image that it wrote (TransformIndexToPhysicalPoint).
    for (voxel, place_mm) in [
        ([0.0, 0.0, 0.0], [-12.5, 7.25, 100.0]),
        ([4.0, 0.0, 0.0], [-10.744834876219254, 8.208851077208406, 100.0]),
        ([0.0, 5.0, 0.0], [-14.077758096514806, 10.138066823502761, 101.79784576976576]),
        ([0.0, 0.0, 3.0], [-11.120906917604419, 4.725587045576311, 105.26549537134224]),
        ([4.0, 5.0, 3.0], [-10.94349989033848, 8.572504946287477, 107.063341141108]),
    ] {
        let place_m = info.frame.origin_m + info.frame.axes_m * DVec3::from(voxel);
        assert!((place_m * 1e3).abs_diff_eq(DVec3::from(place_mm), 1e-6), "{voxel:?}: {place_m}");
    }
}

#[test]
fn values_are_rescaled() {
    let mut reader = opened("rescaled");
    assert_eq!((reader.info().slope, reader.info().intercept), (0.5, -1024.0));
    assert_eq!(reader.info().element, Element::U16);
    let expected_values = expected(of_slices(4), |x, y, z| ramp(x, y, z) * 0.5 - 1024.0);
    assert_eq!(values(reader.as_mut()).unwrap(), expected_values);
    let voxel_mm = reader.info().frame.voxel_size_m() * 1e3;
    assert!(voxel_mm.abs_diff_eq(DVec3::new(0.5, 0.75, 2.0), 1e-9), "{voxel_mm}: the thickness is 5");
}

#[test]
fn the_modality_is_what_the_tag_says() {
    // SimpleITK writes CT whose values have the rescale type US, unspecified.
    for (name, modality) in
        [("rescaled", Modality::Ct), ("oblique", Modality::Unknown), ("pet", Modality::Unknown)]
    {
        assert_eq!(opened(name).info().modality, modality, "{name}");
    }
    let mut bytes = std::fs::read(file("odd.dcm")).unwrap();
    let tag = b"\x08\x00\x60\x00CS\x02\x00";
    let value = bytes.windows(tag.len()).position(|window| window == tag).unwrap() + tag.len();
    for (told, modality) in [(b"CT", Modality::Ct), (b"MR", Modality::Mr), (b"XA", Modality::Unknown)] {
        bytes[value..value + 2].copy_from_slice(told);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slice.dcm");
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(open(&path, &Selection::default()).unwrap().info().modality, modality);
    }
}

#[test]
fn slices_with_scalings_of_their_own_are_values() {
    let mut reader = opened("pet");
    assert_eq!((reader.info().slope, reader.info().element), (1.0, Element::F32));
    assert_eq!(values(reader.as_mut()).unwrap(), expected(of_slices(4), |x, y, z| ramp(x, y, z) * (z + 1.0)));
}

#[test]
fn bits_beside_the_number_do_not_count() {
    let mut reader = opened("signed12");
    assert_eq!(reader.info().element, Element::I16);
    assert_eq!(values(reader.as_mut()).unwrap(), expected(of_slices(2), |x, y, z| ramp(x, y, z) - 100.0));
}

#[test]
fn every_transfer_syntax_gives_the_same_slice() {
    let slice = expected(SLICE, |x, y, _| ramp(x, y, 1.0));
    for name in [
        "implicit.dcm",
        "deflated.dcm",
        "big_endian.dcm",
        "rle.dcm",
        "jpeg_lossless.dcm",
        "padded.dcm",
        "no_preamble/slice",
    ] {
        assert_eq!(values(opened(name).as_mut()).unwrap(), slice, "{name}");
    }
    let grey = values(opened("jpeg_baseline.dcm").as_mut()).unwrap();
    assert!(grey.iter().all(|value| (value - 77.0).abs() <= 1.0), "{grey:?}");
    let odd = values(opened("odd.dcm").as_mut()).unwrap();
    assert_eq!(odd, [0, 1, 2, 3, 4, 5, 6, 7, 8].map(f64::from));
}

#[test]
fn frames_of_one_file_lie_where_they_say() {
    for name in ["enhanced.dcm", "enhanced_rle.dcm"] {
        let mut reader = opened(name);
        let expected_values = expected(of_slices(4), |x, y, z| ramp(x, y, z) * 2.0 + 5.0);
        assert_eq!(values(reader.as_mut()).unwrap(), expected_values, "{name}");
        let frame = reader.info().frame;
        assert!(frame.voxel_size_m().abs_diff_eq(DVec3::new(0.5e-3, 0.75e-3, 2e-3), 1e-12));
        assert!(frame.origin_m.abs_diff_eq(DVec3::new(1e-3, 2e-3, 3e-3), 1e-12));
    }
    let mut reader = opened("frames.dcm");
    assert_eq!(values(reader.as_mut()).unwrap(), expected(of_slices(4), ramp));
    assert!((reader.info().frame.voxel_size_m().z - 2e-3).abs() < 1e-12);
}

#[test]
fn one_file_stands_for_its_series() {
    let mut reader = opened("two_series/2_1");
    assert_eq!(reader.info().name, "Series 2");
    assert_eq!(values(reader.as_mut()).unwrap(), expected(of_slices(2), ramp));
}

#[test]
fn of_several_series_one_is_chosen() {
    let said = said_of("two_series");
    assert!(said.contains("2 series") && said.contains("2 \"Series 2\" (CT, 2 slices of 5 × 6"), "{said}");
    for asked in ["2", "1.2.3.2", "3.2"] {
        let selection = Selection { series: Some(asked.into()), ..Default::default() };
        assert_eq!(open(&file("two_series"), &selection).unwrap().info().name, "Series 2", "{asked}");
    }
    for asked in ["3", "1.2.3", "", "x"] {
        let selection = Selection { series: Some(asked.into()), ..Default::default() };
        assert!(complaint("two_series", &selection).contains("choose one by its number"), "{asked}");
    }
    let said = said_of("localizer");
    assert!(said.contains("2 series") && said.contains("1 slices"), "{said}");
}

#[test]
fn what_is_wrong_with_a_stack_is_said_with_its_place() {
    let said = said_of("missing");
    assert!(
        said.contains("1 slice is missing") && said.contains("between 1 (instance 2) at 32.00 mm"),
        "{said}"
    );
    let said = said_of("duplicate");
    assert!(said.contains("1 (instance 2) and copy (instance 9)"), "{said}");
    let said = said_of("uneven");
    assert!(said.contains("not evenly spaced: 2.500 mm between 1 (instance 2)"), "{said}");
    let given = Selection { spacing_mm: Some(DVec3::new(1.0, 2.0, 3.0)), ..Default::default() };
    let frame = open(&file("uneven"), &given).unwrap().info().frame;
    assert_eq!(frame.voxel_size_m(), DVec3::new(1e-3, 2e-3, 3e-3));
}

#[test]
fn a_tilted_gantry_makes_a_sheared_frame() {
    let frame = opened("tilted").info().frame;
    assert!(frame.axes_m.z_axis.abs_diff_eq(DVec3::new(0.0, 0.5e-3, 2e-3), 1e-12), "{frame:?}");
}

#[test]
fn of_several_images_at_each_place_one_is_chosen() {
    let said = said_of("echoes");
    assert!(said.contains("2 images lie at each of the 2 places (they differ in EchoTime)"), "{said}");
    assert!(said.contains("choose one by its time, 0 to 1"), "{said}");
    for (time, offset) in [(0, 1000.0), (1, 0.0)] {
        let selection = Selection { time: Some(time), ..Default::default() };
        let mut reader = open(&file("echoes"), &selection).unwrap();
        assert_eq!(
            values(reader.as_mut()).unwrap(),
            expected(of_slices(2), |x, y, z| ramp(x, y, z) + offset)
        );
    }
    let selection = Selection { time: Some(2), ..Default::default() };
    assert!(complaint("echoes", &selection).contains("time 2 is asked for"));
}

#[test]
fn what_is_not_read_is_said() {
    let said = said_of("jpeg_2000.dcm");
    assert!(said.contains("JPEG 2000") && said.contains("gdcmconv"), "{said}");
    assert!(said_of("colours.dcm").contains("3 samples per pixel"));
    assert!(said_of("no_image.dcm").contains("holds no image"));
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(file("no_image.dcm"), folder.path().join("a")).unwrap();
    let said = open(folder.path(), &Selection::default()).unwrap_err().to_string();
    assert!(said.contains("no DICOM image"), "{said}");
}

#[test]
fn slices_are_read_in_any_order() {
    for name in ["enhanced.dcm", "enhanced_rle.dcm", "pet"] {
        let mut reader = opened(name);
        let all = values(reader.as_mut()).unwrap();
        let mut slab = Samples::new(reader.info().element, 30);
        for z in [2, 3, 0, 3, 1] {
            reader.read_slab(z, &mut slab).unwrap();
            assert_eq!(reader.info().value(slab.get(7)), all[30 * z as usize + 7], "{name} slab {z}");
        }
    }
}

/// Reads a file with these bytes, alone in its folder.
fn read_bytes(folder: &Path, bytes: &[u8]) -> Result<Vec<f64>, String> {
    let path = folder.join("slice");
    std::fs::write(&path, bytes).unwrap();
    let read = open(&path, &Selection::default()).and_then(|mut reader| some_values(reader.as_mut()));
    read.map_err(|error| error.to_string())
}

const DAMAGED: [&str; 7] = [
    "implicit.dcm",
    "deflated.dcm",
    "big_endian.dcm",
    "rle.dcm",
    "jpeg_lossless.dcm",
    "jpeg_baseline.dcm",
    "enhanced_rle.dcm",
];

#[test]
fn files_cut_short_at_any_place_are_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for name in DAMAGED {
        let bytes = std::fs::read(file(name)).unwrap();
        // The last bytes of what is packed are end marks and padding, which need not be there.
        for length in (0..bytes.len() - 40).step_by(5) {
            let said = read_bytes(folder.path(), &bytes[..length]).expect_err(name);
            assert!(said.contains(&*folder.path().to_string_lossy()) && !said.contains('\n'), "{said}");
        }
    }
}

#[test]
fn a_wrong_byte_anywhere_is_survived() {
    let folder = tempfile::tempdir().unwrap();
    for name in DAMAGED {
        let bytes = std::fs::read(file(name)).unwrap();
        for at in (128..bytes.len()).step_by(5) {
            for wrong in [0x00, 0x7f, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] = wrong;
                // Wrong numbers are read, or a sentence comes back; nothing else may happen.
                let _ = read_bytes(folder.path(), &damaged);
            }
        }
    }
}
