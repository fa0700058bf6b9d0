//! Headers that promise what is missing or impossible.

use super::damage::complaint;
use super::*;

/// What is said of an NRRD file with these lines and two bytes of voxels.
fn nrrd(lines: &str) -> String {
    complaint("lie.nrrd", format!("NRRD0004\n{lines}\n\nAB").as_bytes())
}

#[test]
fn nrrd_headers_that_lie_are_found_out_before_memory_is_taken() {
    let said = |sizes: &str, rest: &str| nrrd(&format!("type: short\ndimension: 3\nsizes: {sizes}\n{rest}"));
    let raw = "endian: little\nencoding: raw";
    let text = "encoding: ascii";
    assert!(said("1000000 1000000 1000000", raw).contains("too short"));
    assert!(said("1000000 1000000 1", "endian: big\nencoding: gzip").contains("too short"));
    assert!(said("1000000 1000000 1", text).contains("2 characters cannot hold"));
    assert!(said("1 1 1", text).contains("\"AB\" is not a number of type int16"));
    assert!(said("4294967295 4294967295 4294967295", raw).contains("each must be from 1"));
    assert!(said("0 1 1", raw).contains("each must be from 1"));
    assert!(said("5 6", raw).contains("3 numbers"));
    assert!(said("5 -6 4", raw).contains("each must be from 1"));
    assert!(said("5 six 4", raw).contains("number expected"));
    assert!(said("5 6 4", "encoding: raw").contains("endian: little"));
    assert!(said("5 6 4", "endian: little\nencoding: hex").contains("raw, gzip or ascii"));
    assert!(said("5 6 4", &format!("{raw}\nspacings: 1 0 1")).contains("voxel size"));
    assert!(said("1 1 1", &format!("{raw}\nbyte skip: 18446744073709551615")).contains("number expected"));
    assert!(said("1 1 1", &format!("{raw}\nbyte skip: 9223372036854775807")).contains("too short"));
    assert!(said("1 1 1", &format!("{raw}\nline skip: 9")).contains("too short"));
    assert!(said("1 1 1", "encoding: ascii\nbyte skip: -1").contains("raw encoding"));
}

#[test]
fn nrrd_axes_and_directions_that_lie() {
    let raw = "type: uchar\nencoding: raw";
    let axes = |count: u32, rest: &str| nrrd(&format!("{raw}\ndimension: {count}\n{rest}"));
    assert!(axes(2, "sizes: 1 2").contains("2 axes"));
    assert!(axes(4_000_000_000, "sizes: 1 2").contains("4000000000 axes"));
    assert!(axes(5, "sizes: 1 1 1 1 1").contains("5 of its 5 axes"));
    assert!(axes(3, "sizes: 1 1 2\nkinds: vector domain domain").contains("2 of its 3 axes"));
    let many = ["1048576"; 16].join(" ");
    assert!(axes(16, &format!("sizes: {many}")).contains("16 of its 16"));
    let kinds = "kinds: domain domain domain list";
    assert!(axes(4, &format!("sizes: 1048576 1048576 1048576 2\n{kinds}")).contains("2 channels"));
    let two = "kinds: list vector domain domain domain";
    assert!(axes(5, &format!("sizes: 2 2 1 1 1\n{two}")).contains("not in space"));
    let space = |directions: &str| axes(3, &format!("sizes: 1 1 2\nspace directions: {directions}"));
    assert!(space("(1,0,0) (0,1,0)").contains("3 vectors"));
    assert!(space("(1,0,0) (0,1,0) (0,0,1").contains("a vector like"));
    assert!(space("(1,0,0) (0,1,0) 5").contains("a vector like"));
    assert!(space("(1,0) (0,1) (0,0)").contains("vector of three numbers"));
    assert!(space("(1,0,0) (0,1,0) (0,1,0)").contains("in a plane"));
    assert!(space("(1,0,0) (0,1,0) (0,0,0)").contains("voxel size"));
    assert!(space("(1,0,0) (0,1,0) none").contains("2 of its 3 axes"));
    assert!(space("(1,0,0) (0,1,0) (0,0,1)\nspace origin: (inf,0,0)").contains("not a number"));
}

#[test]
fn files_of_slices_that_are_not_there() {
    let about = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 4\nencoding: raw\ndata file:";
    let said = |files: &str| complaint("lie.nhdr", format!("{about} {files}").as_bytes());
    assert!(said("LIST\na.raw\nb.raw").contains("names 2 files of voxels, and its dimensions need 4"));
    assert!(said("LIST 3\na\nb\nc").contains("names 3 files"));
    assert!(said("LIST 4\na.raw").contains("cannot have 4"));
    assert!(said("LIST\nlie.nhdr\nb\nc\nd").contains("/b: "));
    assert!(said("LIST 3\nlie.nhdr\nb").contains("/b: "));
    assert!(said("LIST").contains("names 0 files"));
    assert!(said("s%02d.raw 1 4 1").contains("/s01.raw: "));
    assert!(said("s%02d.raw 1 4 2").contains("names 2 files"));
    assert!(said("s%02d.raw 1 1048577 1").contains("cannot open"));
    assert!(said("").contains("`data file` is empty") || said("").contains("not understood"));
    let about = "NDims = 3\nDimSize = 2 1 4\nElementType = MET_UCHAR\nElementDataFile =";
    let said = |files: &str| complaint("lie.mhd", format!("{about} {files}").as_bytes());
    assert!(said("LIST\na.raw").contains("names 1 files of voxels"));
    assert!(said("LIST 2D\nlie.mhd\nb\nc\nd").contains("/b: "));
    assert!(said("s%d.raw").contains("/s1.raw: "));
    assert!(said("s%d.raw 1 3").contains("names 3 files"));
}

#[test]
fn a_slice_that_is_too_short_is_named() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["list.nhdr", "slice_01.raw", "slice_02.raw", "slice_03.raw", "slice_04.raw"] {
        std::fs::copy(data(name), folder.path().join(name)).unwrap();
    }
    std::fs::write(folder.path().join("slice_03.raw"), [0; 59]).unwrap();
    let said = open(&folder.path().join("list.nhdr"), &Selection::default()).unwrap_err().to_string();
    assert!(said.contains("slice_03.raw is too short: 60 bytes"), "{said}");
}

#[test]
fn metaimage_headers_that_lie() {
    let with = |lines: &str| complaint("lie.mha", format!("{lines}\nElementDataFile = LOCAL\nAB").as_bytes());
    let about = "NDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR";
    let said = |lines: &str| with(&format!("{about}\n{lines}"));
    assert!(with("NDims = 2").contains("2 axes"));
    assert!(with("NDims = 3\nDimSize = 1 1 2\nElementType = MET_STRING").contains("MET_STRING"));
    assert!(with("NDims = 3\nDimSize = 1 1\nElementType = MET_UCHAR").contains("3 numbers"));
    assert!(said("ElementNumberOfChannels = 2").contains("2 channels"));
    assert!(said("ElementNumberOfChannels = 0").contains("each must be from 1"));
    assert!(said("ElementNumberOfChannels = -9").contains("each must be from 1"));
    assert!(said("BinaryData = False").contains("characters cannot hold"));
    assert!(said("BinaryData = False\nCompressedData = True").contains("packed and written as text"));
    assert!(said("CompressedData = True").contains("cannot read"));
    let beside = |size: &str| {
        let lines = format!("{about}\nHeaderSize = {size}\nElementDataFile = lie.mhd");
        complaint("lie.mhd", lines.as_bytes())
    };
    assert!(beside("18446744073709551615").contains("too short"));
    assert!(beside("-2").contains("number expected"));
    let large = "NDims = 4\nDimSize = 1048576 1048576 1048576 1048576\nElementType = MET_UCHAR";
    assert!(with(large).contains("points in time"));
}

/// What is said of a file of the tests with some bytes changed.
fn changed(name: &str, copy: &str, at: usize, value: &[u8]) -> String {
    let mut bytes = std::fs::read(data(name)).unwrap();
    bytes[at..at + value.len()].copy_from_slice(value);
    complaint(copy, &bytes)
}

#[test]
fn nifti_headers_that_lie() {
    let with = |at: usize, value: &[u8]| changed("ushort.nii", "lie.nii", at, value);
    assert!(with(0, &540i32.to_le_bytes()).contains("neither n+2 nor ni2"));
    assert!(with(0, &1i32.to_le_bytes()).contains("starts with 348"));
    assert!(with(344, b"\0\0\0\0").contains("Analyze"));
    assert!(with(344, b"ni1\0").contains("lie.img"));
    assert!(with(42, &32767i16.to_le_bytes()).contains("too short"));
    assert!(with(42, &(-1i16).to_le_bytes()).contains("each must be from 1"));
    assert!(with(40, &9i16.to_le_bytes()).contains("axes"));
    assert!(with(40, &[7, 0, 5, 0, 6, 0, 4, 0, 1, 0, 1, 0, 2, 0]).contains("along axis 6"));
    assert!(with(70, &128i16.to_le_bytes()).contains("data type 128 (colours)"));
    assert!(with(70, &32i16.to_le_bytes()).contains("complex"));
    assert!(with(108, &f32::NAN.to_le_bytes()).contains("start at byte"));
    assert!(with(108, &1e8f32.to_le_bytes()).contains("too short"));
    assert!(changed("pair.img", "lone.img", 0, &[]).contains("lone.hdr is not there"));
    assert!(with(123, &[7]).contains("unknown code 7"));
}

#[test]
fn nifti_2_headers_that_lie() {
    // Its numbers have their most significant byte first.
    let with = |at: usize, value: &[u8]| changed("nifti2_big.nii", "lie.nii", at, value);
    assert!(with(4, b"n+1\0").contains("neither n+2 nor ni2"));
    assert!(with(24, &i64::MAX.to_be_bytes()).contains("each must be from 1"));
    assert!(with(24, &1_048_576i64.to_be_bytes()).contains("too short"));
    assert!(with(16, &i64::MIN.to_be_bytes()).contains("1 to 7 are possible"));
    assert!(with(168, &i64::MAX.to_be_bytes()).contains("start at byte"));
    assert!(with(4, b"ni2\0").contains("lie.img"));
}

#[test]
fn a_nifti_orientation_that_cannot_be_is_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flat.nii");
    let mut bytes = std::fs::read(data("ushort.nii")).unwrap();
    bytes[280..328].fill(0);
    std::fs::write(&path, &bytes).unwrap();
    let frame = open(&path, &Selection::default()).unwrap().info().frame;
    assert_eq!((frame.voxel_size_m(), frame.space), (frame.axes_m * DVec3::ONE, Space::Unknown));
    bytes[80..84].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(complaint("lie.nii", &bytes).contains("voxel size"));
}
