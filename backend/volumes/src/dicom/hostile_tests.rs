//! DICOM files made here, element by element: hostile ones, and kinds that the other tests have no file of.

use crate::reader_tests::values;
use crate::{Selection, open};
use bricks::volume::{Element, VolumeInfo};
use dicom_dictionary_std::uids;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use std::io::Write;
use std::path::Path;

/// Nested so deep, sequences overflowed the stack of the parser.
const TOO_DEEP: usize = 10_000;
const SEQUENCE: [u16; 2] = [0x0008, 0x1140];
const PRIVATE: [u16; 2] = [0x0009, 0x1001];
const UNDEFINED: u32 = u32::MAX;

fn tag([group, element]: [u16; 2]) -> Vec<u8> {
    [group.to_le_bytes(), element.to_le_bytes()].concat()
}

/// An element with the type and length in the file; types of two letters have the short form.
fn explicit(place: [u16; 2], vr: &str, value: &[u8]) -> Vec<u8> {
    let head = [&tag(place), vr.as_bytes()].concat();
    match vr {
        "OF" | "OD" | "OW" => [&head, &[0; 2][..], &(value.len() as u32).to_le_bytes(), value].concat(),
        _ => [&head, &(value.len() as u16).to_le_bytes()[..], value].concat(),
    }
}

fn number(place: [u16; 2], number: u16) -> Vec<u8> {
    explicit(place, "US", &number.to_le_bytes())
}

/// The header of a sequence; `vr` is empty where types are not in the file.
fn sequence(place: [u16; 2], vr: &str, length: u32) -> Vec<u8> {
    let reserved: &[u8] = if vr.is_empty() { &[] } else { &[0; 2] };
    [&tag(place), vr.as_bytes(), reserved, &length.to_le_bytes()].concat()
}

fn item(length: u32) -> Vec<u8> {
    [tag([0xfffe, 0xe000]), length.to_le_bytes().to_vec()].concat()
}

fn ends() -> Vec<u8> {
    [tag([0xfffe, 0xe00d]), vec![0; 4], tag([0xfffe, 0xe0dd]), vec![0; 4]].concat()
}

/// Preamble, magic, meta group, and these elements.
fn file(syntax: &str, elements: &[u8]) -> Vec<u8> {
    let mut uid = syntax.as_bytes().to_vec();
    uid.resize(uid.len().next_multiple_of(2), 0);
    let syntax = explicit([2, 0x10], "UI", &uid);
    let length = explicit([2, 0], "UL", &(syntax.len() as u32).to_le_bytes());
    [&[0; 128], &b"DICM"[..], &length, &syntax, elements].concat()
}

/// The description and the values of a file with these bytes.
fn read(bytes: &[u8]) -> Result<(VolumeInfo, Vec<f64>), String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slice.dcm");
    std::fs::write(&path, bytes).unwrap();
    let read = open(&path, &Selection::default())
        .and_then(|mut reader| Ok((reader.info().clone(), values(reader.as_mut())?)));
    read.map_err(|error| error.to_string())
}

fn complaint(bytes: &[u8]) -> String {
    read(bytes).unwrap_err()
}

#[test]
fn deep_sequences_are_refused_however_they_are_written() {
    let explicit_le = uids::EXPLICIT_VR_LITTLE_ENDIAN;
    let nested = |place, vr| [sequence(place, vr, UNDEFINED), item(UNDEFINED)].concat().repeat(TOO_DEEP);
    let deflated = |bytes: &[u8]| {
        let mut packed = DeflateEncoder::new(Vec::new(), Compression::default());
        packed.write_all(bytes).unwrap();
        packed.finish().unwrap()
    };
    let sequences = nested(SEQUENCE, "SQ");
    // Lengths that all reach to the end; and, of a known sequence, a length that ends before its item begins.
    let mut defined = Vec::new();
    for depth in 0..TOO_DEEP {
        let rest = (20 * (TOO_DEEP - depth)) as u32;
        defined.extend([sequence(SEQUENCE, "SQ", rest - 12), item(rest - 20)].concat());
    }
    let lying = [sequence(SEQUENCE, "", 4), item(UNDEFINED)].concat().repeat(TOO_DEEP);
    for (name, bytes, word) in [
        ("sequences", file(explicit_le, &sequences), "64 deep"),
        ("unknown types", file(explicit_le, &nested(PRIVATE, "UN")), "64 deep"),
        ("other types", file(explicit_le, &nested(PRIVATE, "OB")), "64 deep"),
        ("implicit", file(uids::IMPLICIT_VR_LITTLE_ENDIAN, &nested(PRIVATE, "")), "64 deep"),
        ("lengths", file(explicit_le, &defined), "64 deep"),
        ("lying lengths", file(uids::IMPLICIT_VR_LITTLE_ENDIAN, &lying), "64 deep"),
        ("deflated", file(uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN, &deflated(&sequences)), "64 deep"),
        ("padded name", file("1.2.840.10008.1.2\t", &nested(SEQUENCE, "")), "64 deep"),
        ("no meta group", [explicit([8, 5], "CS", b"ISO_IR 100"), sequences.clone()].concat(), "64 deep"),
    ] {
        // On a stack like that of the threads that read folders.
        let said = std::thread::scope(|scope| scope.spawn(|| complaint(&bytes)).join().unwrap());
        assert!(said.contains(word), "{name}: {said}");
    }
}

/// A picture of 3 × 2 numbers with these elements before those that describe it.
fn image(before: &[u8], bits: u16, pixels: &[u8]) -> Vec<u8> {
    let of_integers = [[0x28, 0x101], [0x28, 0x102], [0x28, 0x103]];
    let meaning =
        [bits, bits - 1, 0].into_iter().zip(of_integers).flat_map(|(value, place)| number(place, value));
    let [rows, columns, allocated] = [([0x28, 0x10], 2), ([0x28, 0x11], 3), ([0x28, 0x100], bits)]
        .map(|(place, value)| number(place, value));
    let elements = [before, &rows, &columns, &allocated, &meaning.collect::<Vec<u8>>(), pixels].concat();
    file(uids::EXPLICIT_VR_LITTLE_ENDIAN, &elements)
}

fn of_bytes() -> Vec<u8> {
    explicit([0x7fe0, 0x10], "OW", &[0, 1, 2, 3, 4, 5])
}

#[test]
fn sequences_as_deep_as_reports_have_them_are_read() {
    let depth = 30;
    let nested = [sequence(SEQUENCE, "SQ", UNDEFINED), item(UNDEFINED)].concat().repeat(depth);
    let bytes = image(&[nested, ends().repeat(depth)].concat(), 8, &of_bytes());
    assert_eq!(read(&bytes).unwrap().1, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
}

/// A file beside the one that was given does not matter, whatever it is.
#[test]
fn a_hostile_neighbour_is_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let nested = [sequence(SEQUENCE, "SQ", UNDEFINED), item(UNDEFINED)].concat().repeat(TOO_DEEP);
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("hostile.dcm", &file(uids::EXPLICIT_VR_LITTLE_ENDIAN, &nested));
    write("good.dcm", &image(&[], 8, &of_bytes()));
    open(&folder.path().join("good.dcm"), &Selection::default()).unwrap();
    let said = open(folder.path(), &Selection::default()).unwrap_err().to_string();
    assert!(said.contains("hostile.dcm") && said.contains("64 deep"), "{said}");
}

#[test]
fn files_without_preamble_or_meta_group_are_read() {
    let bytes = image(&explicit([8, 5], "CS", b"ISO_IR 100"), 8, &of_bytes());
    let meta = 132;
    let elements = bytes.windows(6).position(|bytes| bytes == b"\x08\0\x05\0CS").unwrap();
    for start in [0, 128, meta, elements] {
        assert_eq!(read(&bytes[start..]).unwrap().1, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "from byte {start}");
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("1"), &bytes[start..]).unwrap();
        open(folder.path(), &Selection::default()).unwrap();
    }
    // The same without types: lengths of four bytes, as the oldest programs write.
    let implicit = |place, value: &[u8]| {
        [tag(place), (value.len() as u32).to_le_bytes().to_vec(), value.to_vec()].concat()
    };
    let numbers =
        [([8, 0x18], 0u16), ([0x28, 0x10], 2), ([0x28, 0x11], 3), ([0x28, 0x100], 8), ([0x28, 0x101], 8)];
    let mut old: Vec<u8> =
        numbers.into_iter().flat_map(|(place, value)| implicit(place, &value.to_le_bytes())).collect();
    old.extend(implicit([0x7fe0, 0x10], &[9, 8, 7, 6, 5, 4]));
    assert_eq!(read(&old).unwrap().1, [9.0, 8.0, 7.0, 6.0, 5.0, 4.0]);
}

#[test]
fn parametric_maps_hold_floats() {
    let numbers = [0.5, -1.0, 3.25, 1e6, 0.0, 7.0];
    let size = [([0x28, 0x10], 2), ([0x28, 0x11], 3)].map(|(place, value)| number(place, value)).concat();
    let map = |bits, pixels: &[u8]| {
        let elements = [&size[..], &number([0x28, 0x100], bits), pixels].concat();
        file(uids::EXPLICIT_VR_LITTLE_ENDIAN, &elements)
    };
    let floats: Vec<u8> = numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
    let doubles: Vec<u8> = numbers.iter().flat_map(|number: &f64| number.to_le_bytes()).collect();
    let (floats, doubles) = (explicit([0x7fe0, 8], "OF", &floats), explicit([0x7fe0, 9], "OD", &doubles));
    // What follows the pixels keeps them from being the end of the file, so that the parser reads them.
    let padding = explicit([0xfffc, 0xfffc], "OW", &[0; 4]);
    for (bits, pixels, element) in [(32, floats, Element::F32), (64, doubles, Element::F64)] {
        for bytes in [map(bits, &pixels), map(bits, &[&pixels[..], &padding].concat())] {
            let (info, found) = read(&bytes).unwrap();
            assert_eq!((info.element, found), (element, numbers.to_vec()));
        }
    }
}

#[test]
fn a_jpeg_of_another_size_is_seen_before_it_is_unpacked() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/dicom/jpeg_baseline.dcm");
    let bytes = std::fs::read(path).unwrap();
    let rows = [tag([0x28, 0x10]), b"US\x02\0".to_vec()].concat();
    let at = bytes.windows(rows.len()).position(|bytes| bytes == rows).unwrap() + rows.len();
    let mut smaller = bytes.clone();
    smaller[at] -= 1;
    let said = complaint(&smaller);
    assert!(said.contains("holds a JPEG of 5 × 6 pixels"), "{said}");
}

#[test]
fn slices_without_positions_have_no_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slice");
    std::fs::write(&path, image(&[], 8, &of_bytes())).unwrap();
    let later = Selection { time: Some(1), ..Default::default() };
    assert!(open(&path, &later).unwrap_err().to_string().contains("one point in time"));
}

/// Of sequences with lengths, an inner one that reaches beyond the outer one.
#[test]
fn lengths_that_contradict_each_other_are_refused() {
    let inner = [sequence(SEQUENCE, "SQ", 8), item(0)].concat();
    let after = number([0x28, 0x10], 1);
    let bytes = [sequence(SEQUENCE, "SQ", 8 + 12), item(12), inner, after].concat();
    assert!(complaint(&file(uids::EXPLICIT_VR_LITTLE_ENDIAN, &bytes)).contains("contradict"));
}

/// The parser reads two whole numbers of ten bytes, and takes the rest for the start of an element with a length of 3 GB.
#[test]
fn numbers_that_are_cut_in_two_are_refused() {
    let cut = [&4_u32.to_le_bytes()[..], &4_u32.to_le_bytes(), &[0; 2]].concat();
    let behind = explicit([0x0009, 0x1001], "LO", b"1.2.840.113619.2.115");
    let elements = [explicit([0x0008, 0x0000], "UL", &cut), behind].concat();
    let said = complaint(&file(uids::EXPLICIT_VR_LITTLE_ENDIAN, &elements));
    assert!(said.contains("element (0008,0000) has 10 bytes, but its numbers have 4 each"), "{said}");
    let implicit = [tag([0x0830, 0]), 14_u32.to_le_bytes().to_vec(), b"142549.216185 ".to_vec()].concat();
    let said = complaint(&file(uids::IMPLICIT_VR_LITTLE_ENDIAN, &implicit));
    assert!(said.contains("element (0830,0000) has 14 bytes"), "{said}");
}

#[test]
fn descriptions_are_one_line_of_letters() {
    let description = |text: &str| {
        let before = explicit([8, 0x103e], "LO", text.as_bytes());
        read(&image(&before, 8, &of_bytes())).unwrap().0.name
    };
    assert_eq!(description("two\r\nlines"), "two  lines");
    assert_eq!(description("\u{1b}[31mred\u{7} "), "[31mred");
}
