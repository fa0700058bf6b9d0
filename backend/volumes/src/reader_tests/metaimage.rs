//! MetaImage files of SimpleITK, and headers that it reads.

use super::*;
use bricks::volume::{Modality, VolumeInfo};

#[test]
fn every_type_and_packing() {
    check("short.mhd", Element::I16, ramp);
    check("ushort_zlib.mha", Element::U16, ramp);
    check("double.mha", Element::F64, ramp);
    check("all_uint8.mha", Element::U8, low_ramp);
    check("all_int8.mha", Element::I8, falling_ramp);
    check("all_int32.mha", Element::I32, ramp);
    check("all_uint32.mha", Element::U32, ramp);
    check("all_int64.mha", Element::I64, ramp);
    check("all_uint64.mha", Element::U64, ramp);
    check("all_float32.mha", Element::F32, ramp);
    check("long.mha", Element::I32, ramp);
    check("text.mha", Element::I16, ramp);
    check("big.mhd", Element::U16, ramp);
}

#[test]
fn a_file_for_each_slice() {
    check("list.mhd", Element::U16, ramp);
    check("numbered.mhd", Element::U16, ramp);
}

#[test]
fn channels_and_times() {
    for index in 0..3 {
        let low = |x, y, z| low_ramp(x, y, z) + f64::from(index);
        check_chosen("channels.mha", &chosen(Some(index), None), Element::U8, low);
        let later = |x, y, z| ramp(x, y, z) + 5000.0 * f64::from(index);
        check_chosen("times.mha", &chosen(None, Some(index)), Element::I16, later);
    }
    assert!(refusal("channels.mha", &chosen(None, None)).contains("it has 3 channels: choose one"));
    assert!(refusal("times.mha", &chosen(None, Some(4))).contains("3 points in time"));
}

#[test]
fn places_are_those_of_simple_itk() {
    // TransformIndexToPhysicalPoint of SimpleITK 2.5 (ITK 5.4), as make_formats.py prints it.
    let places_mm = [[11.0, -22.0, 33.0], [9.019384572581046, -21.3892279960223, 40.05454605823982]];
    check_places("oblique.mha", Space::Patient, places_mm, EXACT_MM);
    // With time ITK writes no letters for an orientation that it writes letters for without.
    let later = open(&data("times.mha"), &chosen(None, Some(1))).unwrap();
    assert_eq!(later.info().frame.space, Space::Patient);
    // A space of which nothing is said keeps its axes.
    check_places("list.mhd", Space::Unknown, [[0.0; 3], [2.0, 3.75, 6.0]], EXACT_MM);
}

#[test]
fn the_modality_is_what_the_header_says() {
    for (line, modality) in [
        ("Modality = MET_MOD_CT", Modality::Ct),
        ("Modality = MET_MOD_MR", Modality::Mr),
        ("Modality = MET_MOD_UNKNOWN", Modality::Unknown),
        ("", Modality::Unknown),
    ] {
        assert_eq!(with_lines(line).unwrap().modality, modality, "{line}");
    }
}

/// The frame of a header with these lines.
fn frame(lines: &str) -> Result<VolumeFrame, VolumeError> {
    Ok(with_lines(lines)?.frame)
}

fn with_lines(lines: &str) -> Result<VolumeInfo, VolumeError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.mha");
    let about = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR";
    std::fs::write(&path, format!("{about}\n{lines}\nElementDataFile = LOCAL\n12345678")).unwrap();
    Ok(open(&path, &Selection::default())?.info().clone())
}

#[test]
fn the_fields_of_a_frame_have_several_names() {
    for (matrix, origin) in
        [("TransformMatrix", "Offset"), ("Orientation", "Position"), ("Rotation", "Origin")]
    {
        let lines = format!("{matrix} = 0 1 0 -1 0 0 0 0 1\n{origin} = 1 2 3\nElementSpacing = 4 5 6");
        let found = frame(&format!("{lines}\nAnatomicalOrientation = ???\nDistanceUnits = cm")).unwrap();
        assert_eq!((found.origin_m, found.space), (DVec3::new(1.0, 2.0, 3.0) * 1e-2, Space::Unknown));
        assert_eq!(found.axes_m.x_axis, DVec3::new(0.0, 4e-2, 0.0));
        assert_eq!(found.axes_m.y_axis, DVec3::new(-5e-2, 0.0, 0.0));
    }
    assert_eq!(frame("AnatomicalOrientation = RAI").unwrap().space, Space::Patient);
    assert!(frame("DistanceUnits = mile").unwrap_err().to_string().contains("mile"));
    assert!(frame("Offset = 1 2").unwrap_err().to_string().contains("3 numbers"));
    let flat = frame("TransformMatrix = 0 0 0 0 0 0 0 0 0").unwrap_err();
    assert!(flat.to_string().contains("no three directions"));
}
