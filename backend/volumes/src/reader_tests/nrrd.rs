//! NRRD files of SimpleITK and pynrrd, and headers that teem's reader in SimpleITK reads.

use super::*;

#[test]
fn every_type_and_encoding() {
    check("short.nrrd", Element::I16, ramp);
    check("ushort_gzip.nrrd", Element::U16, ramp);
    check("float.nhdr", Element::F32, ramp);
    check("big_directions.nrrd", Element::I16, ramp);
    check("spacings_gzip.nhdr", Element::F64, ramp);
    check("char.nrrd", Element::I8, falling_ramp);
    check("all_uint8.nrrd", Element::U8, low_ramp);
    check("all_int32.nrrd", Element::I32, ramp);
    check("all_uint32.nrrd", Element::U32, ramp);
    check("all_int64.nrrd", Element::I64, ramp);
    check("all_uint64.nrrd", Element::U64, ramp);
    check("uint32_big.nrrd", Element::U32, ramp);
    check("float64_big.nrrd", Element::F64, ramp);
    check("int32_ascii.nrrd", Element::I32, ramp);
    check("float32_ascii.nhdr", Element::F32, ramp);
}

#[test]
fn a_file_for_each_slice() {
    check("list.nhdr", Element::U16, ramp);
    check("numbered.nhdr", Element::U16, ramp);
}

#[test]
fn channels_and_times() {
    for index in 0..3 {
        let more = |step: f64| move |x, y, z| ramp(x, y, z) + step * f64::from(index);
        let low = |x, y, z| low_ramp(x, y, z) + f64::from(index);
        check_chosen("channels.nrrd", &chosen(Some(index), None), Element::U8, low);
        check_chosen("times.nrrd", &chosen(None, Some(index)), Element::I16, more(5000.0));
        if index < 2 {
            check_chosen("list_last.nrrd", &chosen(Some(index), None), Element::I16, more(1000.0));
        }
    }
    assert!(refusal("channels.nrrd", &chosen(None, None)).contains("it has 3 channels: choose one"));
    assert!(refusal("channels.nrrd", &chosen(Some(3), None)).contains("not a number 3"));
    assert!(refusal("times.nrrd", &chosen(None, None)).contains("3 points in time"));
    assert!(refusal("list_last.nrrd", &chosen(None, None)).contains("2 channels"));
    assert!(refusal("short.nrrd", &chosen(None, Some(1))).contains("one point in time"));
    check_chosen("short.nrrd", &chosen(Some(0), Some(0)), Element::I16, ramp);
}

#[test]
fn places_are_those_of_simple_itk() {
    // TransformIndexToPhysicalPoint of SimpleITK 2.5 (ITK 5.4), as make_formats.py prints it.
    let places_mm = [[11.0, -22.0, 33.0], [9.019384572581046, -21.3892279960223, 40.05454605823982]];
    check_places("oblique.nrrd", Space::Patient, places_mm, EXACT_MM);
    let places_mm = [[11.0, 22.0, 33.0], [9.019384572581046, 21.3892279960223, 40.05454605823982]];
    check_places("oblique_las.nrrd", Space::Patient, places_mm, EXACT_MM);
    // Nothing is said of the space: the axes alone.
    check_places("uint32_big.nrrd", Space::Unknown, [[0.0; 3], [2.0, 3.75, 6.0]], EXACT_MM);
}

/// The frame of a header with these lines.
fn frame(lines: &str) -> VolumeFrame {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.nrrd");
    let text =
        format!("NRRD0005\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n{lines}\n\n12345678");
    std::fs::write(&path, text).unwrap();
    open(&path, &Selection::default()).unwrap().info().frame
}

#[test]
fn lengths_without_a_space() {
    let found =
        frame("spacings: 1 nan -3\naxis mins: 5 6 nan\ncenters: cell node cell\nunits: \"cm\" \"\" \"mm\"");
    assert!((found.voxel_size_m() - DVec3::new(1e-2, 1e-3, 3e-3)).length() < 1e-15);
    assert!((found.origin_m - DVec3::new(55e-3, 6e-3, 0.0)).length() < 1e-15);
    assert_eq!(frame("a:=b\n# c"), VolumeFrame::of_voxels(DVec3::splat(1e-3)));
}

#[test]
fn spaces_by_their_names() {
    let directions = "space directions: (0,1,0) (2,0,0) (0,0,3)\nspace origin: (4, 5, 6)";
    let of = |space: &str| frame(&format!("space: {space}\n{directions}"));
    for (names, signs) in [
        (["left-posterior-superior", "LPS"], [1.0, 1.0]),
        (["right-anterior-superior", "RAS"], [-1.0, -1.0]),
        (["left-anterior-superior", "LAS"], [1.0, -1.0]),
    ] {
        for found in names.map(of) {
            assert_eq!(found.space, Space::Patient);
            assert_eq!(found.axes_m.x_axis, DVec3::new(0.0, signs[1], 0.0) * 1e-3);
            assert_eq!(found.axes_m.y_axis, DVec3::new(2.0 * signs[0], 0.0, 0.0) * 1e-3);
            assert_eq!(found.origin_m, DVec3::new(4.0 * signs[0], 5.0 * signs[1], 6.0) * 1e-3);
        }
    }
    assert_eq!(of("scanner-xyz").space, Space::Unknown);
    let with_time = "space: RAST\nspace directions: (1,0,0,0) (0,1,0,0) (0,0,1,0)\nspace origin: (1,2,3,9)";
    assert_eq!(frame(with_time).origin_m, DVec3::new(-1e-3, -2e-3, 3e-3));
}

#[test]
fn what_precedes_the_voxels_is_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let about = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 2\ndata file: voxels\n";
    for (lines, voxels) in [
        ("encoding: raw\nline skip: 2\nbyte skip: 3", "a line\nanother\n...AB"),
        ("encoding: raw\nbyte skip: -1", "anything at all AB"),
        ("encoding: text\nline skip: 1\nbyte skip: 4", "title\nxxxx65,\t66"),
    ] {
        let path = folder.path().join("skip.nhdr");
        std::fs::write(&path, format!("{about}{lines}\n")).unwrap();
        std::fs::write(folder.path().join("voxels"), voxels).unwrap();
        let mut reader = open(&path, &Selection::default()).unwrap();
        assert_eq!(values(reader.as_mut()).unwrap(), [65.0, 66.0], "{lines}");
    }
}

/// The values of a volume with these lines and voxels, of bytes.
fn values_of(lines: &str, voxels: &[u8], channel: u32) -> Vec<f64> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("v.nrrd");
    let header = format!("NRRD0004\ntype: uint8\nencoding: raw\n{lines}\n\n");
    std::fs::write(&path, [header.as_bytes(), voxels].concat()).unwrap();
    values(open(&path, &chosen(Some(channel), None)).unwrap().as_mut()).unwrap()
}

#[test]
fn channels_at_any_axis() {
    let voxels: Vec<u8> = (0..24).collect();
    let of = |kinds: &str, sizes: &str, channel| {
        values_of(&format!("dimension: 4\nsizes: {sizes}\nkinds: {kinds}"), &voxels, channel)
    };
    let pick = |is_chosen: fn(u32) -> bool| -> Vec<f64> {
        (0..24).filter(|&n| is_chosen(n)).map(f64::from).collect()
    };
    assert_eq!(of("list space space space", "2 3 2 2", 1), pick(|n| n % 2 == 1));
    assert_eq!(of("space list space space", "3 2 2 2", 1), pick(|n| n / 3 % 2 == 1));
    assert_eq!(of("space space list space", "3 2 2 2", 0), pick(|n| n / 6 % 2 == 0));
    assert_eq!(of("space space space list", "3 2 2 2", 1), pick(|n| n / 12 % 2 == 1));
}

#[test]
fn rows_longer_than_what_is_read_at_once() {
    let (columns, channels) = (40_000, 3);
    let voxels: Vec<u8> = (0..2 * columns * channels).map(|n| (n % 251) as u8).collect();
    let lines = format!("dimension: 4\nsizes: {channels} {columns} 2 1\nkinds: list space space space");
    let expected: Vec<f64> = voxels.iter().skip(2).step_by(channels).map(|&n| n.into()).collect();
    assert_eq!(values_of(&lines, &voxels, 2), expected);
    // So many channels that each number is read by itself.
    let voxels: Vec<u8> = (0..4 * 70_000u32).map(|n| (n % 251) as u8).collect();
    let lines = "dimension: 4\nsizes: 70000 2 2 1\nkinds: list space space space";
    let expected: Vec<f64> = voxels.iter().skip(69_999).step_by(70_000).map(|&n| n.into()).collect();
    assert_eq!(values_of(lines, &voxels, 69_999), expected);
}
