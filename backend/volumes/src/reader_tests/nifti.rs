//! NIfTI files of nibabel and SimpleITK.

use super::*;

#[test]
fn every_type_and_version() {
    check("ushort.nii", Element::U16, ramp);
    check("short_big.nii.gz", Element::I16, ramp);
    check("float_metres.nii", Element::F32, ramp);
    check("uint_sitk.nii.gz", Element::U32, ramp);
    check("scaled.nii", Element::I16, ramp);
    check("all_uint8.nii.gz", Element::U8, low_ramp);
    check("all_int8.nii.gz", Element::I8, falling_ramp);
    check("all_int32.nii.gz", Element::I32, ramp);
    check("all_int64.nii.gz", Element::I64, ramp);
    check("all_uint64.nii.gz", Element::U64, ramp);
    check("all_float64.nii.gz", Element::F64, ramp);
    check("nifti2.nii.gz", Element::I16, ramp);
    check("nifti2_big.nii", Element::I16, ramp);
}

#[test]
fn either_file_of_a_pair() {
    for name in ["pair.hdr", "pair.img", "pair2.hdr.gz", "pair2.img.gz"] {
        check(name, Element::I16, ramp);
    }
}

#[test]
fn channels_and_times() {
    let value = |channel: u32, time: u32| {
        move |x, y, z| ramp(x, y, z) + f64::from(1000 * channel) + f64::from(5000 * time)
    };
    for time in 0..3 {
        check_chosen("times.nii.gz", &chosen(None, Some(time)), Element::I16, value(0, time));
        for channel in 0..2 {
            let selection = chosen(Some(channel), Some(time));
            check_chosen("times_channels.nii.gz", &selection, Element::I16, value(channel, time));
        }
    }
    assert!(refusal("times.nii.gz", &chosen(None, None)).contains("3 points in time: choose one"));
    assert!(refusal("times.nii.gz", &chosen(Some(1), Some(0))).contains("one channel"));
    assert!(refusal("times_channels.nii.gz", &chosen(None, Some(0))).contains("2 channels"));
    assert!(refusal("times_channels.nii.gz", &chosen(Some(0), Some(3))).contains("from 0 to 2"));
}

#[test]
fn places_are_those_of_nibabel_and_simple_itk() {
    // nibabel's affine, as make_formats.py prints it, x and y turned round (it says right and anterior); SimpleITK's
    // TransformIndexToPhysicalPoint is the same within single precision.
    let by_affine = [[-11.0, 22.0, 33.0], [-11.414720088243484, 15.302694082260132, 29.993906244635582]];
    check_places("sform.nii.gz", Space::Patient, by_affine, EXACT_MM);
    let by_rotation = [[-11.0, 22.0, 33.0], [-11.41472006634648, 15.302693963578179, 29.993906335278716]];
    check_places("qform.nii.gz", Space::Patient, by_rotation, EXACT_MM);
    check_places("qform.nii.gz", Space::Patient, by_affine, SINGLE_MM);
    // Neither is given: the voxels' edges alone.
    check_places("no_form.nii.gz", Space::Unknown, [[0.0; 3], [2.0, 3.75, 6.0]], EXACT_MM);
}

#[test]
fn a_scaling_that_is_no_number_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scaled.nii");
    let scaled = |slope: f32, intercept: f32| {
        let mut bytes = std::fs::read(data("ushort.nii")).unwrap();
        bytes[112..116].copy_from_slice(&slope.to_le_bytes());
        bytes[116..120].copy_from_slice(&intercept.to_le_bytes());
        std::fs::write(&path, bytes).unwrap();
        let info = open(&path, &Selection::default()).unwrap().info().clone();
        (info.slope, info.intercept)
    };
    for slope in [0.0, f32::NAN, f32::INFINITY] {
        assert_eq!(scaled(slope, 7.0), (1.0, 0.0), "{slope}");
    }
    assert_eq!(scaled(2.0, f32::NAN), (2.0, 0.0));
    assert_eq!(scaled(2.0, 7.0), (2.0, 7.0));
}
