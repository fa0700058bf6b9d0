//! The TIFF reader against files that tifffile wrote, and against damaged ones.

use crate::reader_tests::{DIMS, VOXEL_SIZE_M, data, expected, ramp, some_values, values};
use crate::{Selection, open};
use bricks::volume::{Element, Samples, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    data("tiff").join(name)
}

fn selected(name: &str, selection: &Selection) -> Box<dyn VolumeReader> {
    open(&file(name), selection).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn check(name: &str, element: Element, value: impl Fn(f64, f64, f64) -> f64) {
    let mut reader = selected(name, &Selection::default());
    assert_eq!((reader.info().dims, reader.info().element), (DIMS, element), "{name}");
    assert_eq!(values(reader.as_mut()).unwrap(), expected(DIMS, value), "{name}");
}

fn said_of(name: &str, selection: &Selection) -> String {
    let said = open(&file(name), selection).and_then(|mut reader| values(reader.as_mut()));
    let said = said.expect_err(name).to_string();
    assert!(said.contains(name) && !said.contains('\n'), "{said}");
    said
}

fn half(x: f64, y: f64, z: f64) -> f64 {
    (ramp(x, y, z) / 2.0).floor()
}

#[test]
fn every_type_and_packing() {
    for packing in ["plain", "lzw", "zlib", "packbits", "zstd"] {
        let name = |element: &str| format!("{element}_{packing}.tif");
        check(&name("uint8"), Element::U8, half);
        check(&name("int8"), Element::I8, |x, y, z| half(x, y, z) % 120.0);
        check(&name("uint16"), Element::U16, ramp);
        check(&name("int16"), Element::I16, ramp);
        check(&name("uint32"), Element::U32, ramp);
        check(&name("int32"), Element::I32, ramp);
        check(&name("float32"), Element::F32, ramp);
        check(&name("float64"), Element::F64, ramp);
    }
}

#[test]
fn byte_orders_strips_and_predictors() {
    check("big_endian.tif", Element::U16, ramp);
    check("big_endian_lzw.tif", Element::F32, ramp);
    check("big_tiff.tif", Element::U16, ramp);
    check("big_tiff_big_endian.tif", Element::U16, ramp);
    check("strips.tif", Element::U16, ramp);
    check("predictor.tif", Element::U16, ramp);
    check("predictor_float.tif", Element::F32, ramp);
    check("thumbnail.tif", Element::U16, ramp);
}

#[test]
fn tiles_that_do_not_divide_the_page() {
    let dims = UVec3::new(37, 20, 2);
    for name in ["tiled.tif", "tiled_float.tif"] {
        let mut reader = selected(name, &Selection::default());
        assert_eq!(reader.info().dims, dims);
        let expected = expected(dims, |x, y, z| x + 100.0 * y + 1000.0 * z);
        assert_eq!(values(reader.as_mut()).unwrap(), expected, "{name}");
    }
}

#[test]
fn numbers_stay_whatever_they_look_like() {
    check("white_uint8.tif", Element::U8, half);
    check("white_uint16.tif", Element::U16, ramp);
    check("white_int16.tif", Element::I16, ramp);
    check("white_float32.tif", Element::F32, ramp);
    check("palette.tif", Element::U8, half);
}

#[test]
fn a_channel_of_coloured_pages_is_chosen() {
    for name in ["rgb.tif", "rgb_planes.tif"] {
        assert!(said_of(name, &Selection::default()).contains("3 channels: choose the channel, 0 to 2"));
        for channel in 0..3 {
            let selection = Selection { channel: Some(channel), ..Default::default() };
            let value = |x, y, z| ramp(x, y, z) + 1000.0 * f64::from(channel);
            assert_eq!(values(selected(name, &selection).as_mut()).unwrap(), expected(DIMS, value), "{name}");
        }
        let selection = Selection { channel: Some(3), ..Default::default() };
        assert!(said_of(name, &selection).contains("there are 3"));
    }
}

#[test]
fn hyperstacks() {
    for name in ["imagej.tif", "czt.ome.tif", "zct.ome.tif"] {
        let said = said_of(name, &Selection::default());
        assert!(said.contains("2 channels") && said.contains("3 points in time"), "{said}");
        for (channel, time) in [(0, 0), (1, 2), (0, 1)] {
            let selection = Selection { channel: Some(channel), time: Some(time), ..Default::default() };
            let mut reader = selected(name, &selection);
            let value = |x, y, z| ramp(x, y, z) + 1000.0 * f64::from(channel) + 10000.0 * f64::from(time);
            assert_eq!(values(reader.as_mut()).unwrap(), expected(DIMS, value), "{name} {channel} {time}");
            let size = reader.info().frame.voxel_size_m();
            assert!(size.abs_diff_eq(VOXEL_SIZE_M, 1e-9), "{name}: {size}");
        }
    }
}

#[test]
fn stacks_of_imagej() {
    for name in ["imagej_stack.tif", "imagej_one_page.tif", "imagej_one_page_big_endian.tif"] {
        check(name, Element::U16, ramp);
        let size = selected(name, &Selection::default()).info().frame.voxel_size_m();
        assert!(size.abs_diff_eq(VOXEL_SIZE_M, 1e-9), "{name}: {size}");
    }
}

#[test]
fn edges_of_voxels() {
    let size = |name: &str, spacing_mm| {
        let selection = Selection { spacing_mm, ..Default::default() };
        selected(name, &selection).info().frame.voxel_size_m() * 1e3
    };
    assert_eq!(size("uint8_plain.tif", None), DVec3::ONE);
    assert!(size("resolution.tif", None).abs_diff_eq(DVec3::new(0.5e-3, 1e-3, 0.5e-3), 1e-12));
    let given = DVec3::new(1.0, 2.0, 3.0);
    assert!(size("imagej_stack.tif", Some(given)).abs_diff_eq(given, 1e-12));
}

#[test]
fn files_of_a_folder_are_slices_in_natural_order() {
    check("slices", Element::U16, ramp);
    let said = said_of("mixed", &Selection::default());
    assert!(said.contains("b.tiff") && said.contains("5 × 3") && said.contains("a.tif is 5 × 6"), "{said}");
}

#[test]
fn what_is_not_read_is_said() {
    let said = |name| said_of(name, &Selection::default());
    assert!(said("uneven.tif").contains("page 2 is 5 × 3"));
    assert!(said("half.tif").contains("16 bits"));
}

#[test]
fn slabs_are_read_in_any_order() {
    for name in ["uint16_lzw.tif", "imagej_one_page.tif", "slices"] {
        let mut reader = selected(name, &Selection::default());
        let mut slab = Samples::new(reader.info().element, 30);
        for z in [2, 3, 0, 3, 1] {
            reader.read_slab(z, &mut slab).unwrap();
            assert_eq!(slab.get(7), ramp(2.0, 1.0, z.into()), "{name} slab {z}");
        }
    }
}

const DAMAGED: [&str; 9] = [
    "uint16_plain.tif",
    "uint16_lzw.tif",
    "float32_zlib.tif",
    "int16_packbits.tif",
    "uint8_zstd.tif",
    "tiled_float.tif",
    "big_tiff_big_endian.tif",
    "imagej_one_page.tif",
    "rgb_planes.tif",
];

fn read_bytes(folder: &Path, bytes: &[u8]) -> Result<Vec<f64>, String> {
    let path = folder.join("stack.tif");
    std::fs::write(&path, bytes).unwrap();
    let selection = Selection { channel: Some(0), ..Default::default() };
    let read = open(&path, &selection).and_then(|mut reader| some_values(reader.as_mut()));
    read.map_err(|error| error.to_string())
}

#[test]
fn files_cut_short_at_any_place_are_survived() {
    let folder = tempfile::tempdir().unwrap();
    for name in DAMAGED {
        let bytes = std::fs::read(file(name)).unwrap();
        for length in (0..bytes.len() - 1).step_by(7) {
            match read_bytes(folder.path(), &bytes[..length]) {
                Ok(values) => {
                    assert_eq!(values, read_bytes(folder.path(), &bytes).unwrap(), "{name} {length}")
                }
                Err(said) => {
                    assert!(
                        said.contains(&*folder.path().to_string_lossy()) && !said.contains('\n'),
                        "{said}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_wrong_byte_anywhere_is_survived() {
    let folder = tempfile::tempdir().unwrap();
    for name in DAMAGED {
        let bytes = std::fs::read(file(name)).unwrap();
        for at in (0..bytes.len()).step_by(5) {
            for wrong in [0x00, 0x7f, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] = wrong;
                // Wrong numbers are read, or a sentence comes back; nothing else may happen.
                let _ = read_bytes(folder.path(), &damaged);
            }
        }
    }
}

#[test]
fn memory_is_not_taken_for_what_the_file_cannot_hold() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = std::fs::read(file("uint16_plain.tif")).unwrap();
    // The count of the values of the first tag.
    let page = u32::from_le_bytes([4, 5, 6, 7].map(|at| bytes[at])) as usize;
    bytes[page + 6..page + 10].copy_from_slice(&0x7fff_ffffu32.to_le_bytes());
    let said = read_bytes(folder.path(), &bytes).unwrap_err();
    assert!(said.contains("has 2147483647 values"), "{said}");
    // A second page that starts within the tags of the first.
    let mut bytes = [0; 80];
    for (at, value) in [(0, *b"II*\0"), (4, [8, 0, 0, 0]), (8, [4, 0, 4, 0]), (58, [10, 0, 0, 0])] {
        bytes[at..at + 4].copy_from_slice(&value);
    }
    let said = read_bytes(folder.path(), &bytes).unwrap_err();
    assert!(said.contains("its pages overlap"), "{said}");
}

/// Adler's checksum (RFC 1950, 8.2).
fn adler(bytes: &[u8]) -> [u8; 4] {
    let (mut a, mut b) = (1u32, 0u32);
    for &byte in bytes {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    (b << 16 | a).to_be_bytes()
}

fn read_file(path: &Path) -> Result<Vec<f64>, String> {
    let read = open(path, &Selection::default()).and_then(|mut reader| values(reader.as_mut()));
    read.map_err(|error| error.to_string())
}

#[test]
fn the_checksum_of_every_deflated_strip_is_looked_at() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.tif");
    let bytes = std::fs::read(file("uint16_zlib.tif")).unwrap();
    let plane = |z: u16| -> Vec<u8> {
        (0..30).flat_map(|i| (i % 5 + 10 * (i / 5) + 100 * z).to_le_bytes()).collect()
    };
    for z in 0..4 {
        let sum = adler(&plane(z));
        let at = bytes.windows(4).position(|bytes| bytes == sum).expect("each page is a strip");
        let mut wrong = bytes.clone();
        wrong[at + 3] ^= 1;
        std::fs::write(&path, wrong).unwrap();
        let said = read_file(&path).unwrap_err();
        assert!(said.contains(&format!("page {}", z + 1)) && said.contains("copy the file again"), "{said}");
    }
}

/// A page of so many bytes in one strip, with a description, packed as the number says.
fn tiff(width: u32, height: u32, compression: u32, strip: &[u8], description: &[u8]) -> Vec<u8> {
    let strip_at = 8 + 2 + 10 * 12 + 4;
    let description_at = strip_at + strip.len() as u32;
    let tags: [(u16, u16, u32, u32); 10] = [
        (256, 4, 1, width),
        (257, 4, 1, height),
        (258, 3, 1, 8),
        (259, 3, 1, compression),
        (262, 3, 1, 1),
        (270, 2, description.len() as u32, description_at),
        (273, 4, 1, strip_at),
        (277, 3, 1, 1),
        (278, 4, 1, height),
        (279, 4, 1, strip.len() as u32),
    ];
    let entry = |&(tag, kind, count, value): &(u16, u16, u32, u32)| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    let entries: Vec<u8> = tags.iter().flat_map(entry).collect();
    [b"II*\0\x08\0\0\0\x0a\0", &entries[..], &[0; 4], strip, description].concat()
}

/// 4 × 2 bytes packed with Zstandard.
fn zstd_tiff(strip: &[u8]) -> Vec<u8> {
    tiff(4, 2, 50_000, strip, b"a picture\0")
}

/// More pages than memory could list, of which the file holds one.
#[test]
fn pages_that_are_promised_take_no_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stack.tif");
    let description = b"ImageJ=1.54f\nimages=4294967295\nslices=4294967295\n\0";
    std::fs::write(&path, tiff(1, 1, 1, &[7], description)).unwrap();
    let said = read_file(&path).unwrap_err();
    assert!(said.contains("4294967295 bytes of voxels are promised"), "{said}");
}

#[test]
fn the_checksum_of_a_zstandard_strip_is_looked_at() {
    use std::io::Write;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("zstd.tif");
    let mut packed = zstd::Encoder::new(Vec::new(), 3).unwrap();
    packed.include_checksum(true).unwrap();
    packed.write_all(&[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
    let mut strip = packed.finish().unwrap();
    std::fs::write(&path, zstd_tiff(&strip)).unwrap();
    assert_eq!(read_file(&path).unwrap(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    *strip.last_mut().unwrap() ^= 1;
    std::fs::write(&path, zstd_tiff(&strip)).unwrap();
    assert!(read_file(&path).unwrap_err().contains("copy the file again"));
}
