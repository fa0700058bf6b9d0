//! Opens a hostile volume file in several ways, and reads it where it is small.
#![no_main]

use bricks::volume::{ByteOrder, Element, Samples, VolumeReader};
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::{DVec3, UVec3};
use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use lightloom_fuzz::format::{FORMATS, Form};
use std::fs;
use std::io::Write;
use std::panic::PanicHookInfo;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use tempfile::TempDir;
use volumes::{RawLayout, Selection, open};

/// A volume of more bytes is opened, and not read.
const MOST_BYTES: u64 = 1 << 20;
/// More slabs take longer than they teach.
const MOST_SLABS: u32 = 512;
/// What a reader is told that it may use.
const MEMORY_BYTES: u64 = 1 << 20;
/// Memory beside what grows with the file: the slab and what the reader was given, buffers of 256 KiB for the file,
/// the tables of decoders.
const CONSTANT_BYTES: usize = (MOST_BYTES + MEMORY_BYTES) as usize + (6 << 20);
/// Memory per byte of the file: headers are kept as text, as fields, and as lists of names and pages.
const BYTES_PER_BYTE: usize = 64;
/// The same for DICOM, whose elements may be deflated.
const BYTES_PER_BYTE_OF_DICOM: usize = 4 * 1032;
/// The same for TIFF, whose pages are unpacked whole, all channels of them: Zstandard packs 128 KiB into four bytes.
const BYTES_PER_BYTE_OF_TIFF: usize = 1 << 15;
/// Files that headers may name, beside the input's own.
const COMPANIONS: [(&str, &[u8]); 8] = [
    ("input.img", include_bytes!("../../data/pair.img")),
    ("short.raw", include_bytes!("../../data/short.raw")),
    ("slice_01.raw", include_bytes!("../../data/slice_01.raw")),
    ("slice_02.raw", include_bytes!("../../data/slice_02.raw")),
    ("slice_03.raw", include_bytes!("../../data/slice_03.raw")),
    ("slice_04.raw", include_bytes!("../../data/slice_04.raw")),
    ("spacings_gzip.raw.gz", include_bytes!("../../data/spacings_gzip.raw.gz")),
    ("float32_ascii.txt", include_bytes!("../../data/float32_ascii.txt")),
];

/// The folder of this process; it stays when the process ends, and `run` removes it.
static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for (number, (_, form)) in FORMATS.into_iter().enumerate() {
        let folder = folder.path().join(number.to_string());
        fs::create_dir(&folder).expect("the folder takes folders");
        let companions: &[_] = if form == Form::File { &COMPANIONS } else { &[] };
        for (name, bytes) in companions {
            fs::write(folder.join(name), bytes).expect("the folder takes files");
        }
    }
    folder
});

fuzz_target!(init: std::panic::set_hook(Box::new(told)), |data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let number = usize::from(first) % FORMATS.len();
    let (name, form) = FORMATS[number];
    let raw = if form == Form::Raw { raw(bytes) } else { None };
    let Some(path) = write(&FOLDER.path().join(number.to_string()), name, form, bytes) else { return };
    let ratio = match name.rsplit('.').next() {
        Some("tif") => BYTES_PER_BYTE_OF_TIFF,
        Some("dcm") => BYTES_PER_BYTE_OF_DICOM,
        _ => BYTES_PER_BYTE,
    };
    for selection in selections() {
        let selection = Selection { raw: raw.clone(), ..selection };
        let _budget = Budget::new(CONSTANT_BYTES + ratio * bytes.len());
        if let Ok(mut volume) = open(&path, &selection) {
            read(volume.as_mut());
        }
    }
});

/// In the place of libFuzzer's hook, which aborts: the reader of DICOM catches panics of the decoder of JPEG. What is
/// not caught aborts as well, a little later.
fn told(panic: &PanicHookInfo<'_>) {
    eprintln!("{panic}");
}

fn selections() -> [Selection; 3] {
    let plain = Selection { memory_bytes: MEMORY_BYTES, ..Selection::default() };
    let first = Selection { channel: Some(0), time: Some(0), series: Some("1".into()), ..plain.clone() };
    let (spacing_mm, memory_bytes) = (Some(DVec3::new(1.0, 0.5, 2.0)), 1);
    let later = Selection {
        channel: Some(1),
        time: Some(1),
        level: Some(1),
        spacing_mm,
        memory_bytes,
        ..plain.clone()
    };
    [plain, first, later]
}

/// Writes the input where it is to be opened; None where it is not one.
fn write(folder: &Path, name: &str, form: Form, bytes: &[u8]) -> Option<PathBuf> {
    let path = folder.join(name);
    match form {
        Form::File | Form::Raw => fs::write(&path, bytes).ok()?,
        Form::Packed => {
            let mut packed = GzEncoder::new(fs::File::create(&path).ok()?, Compression::fast());
            packed.write_all(bytes).ok()?;
            packed.finish().ok()?;
        }
        Form::Folder => {
            fs::write(&path, bytes).ok()?;
            return Some(folder.into());
        }
        Form::Zarr => {
            let split = bytes.iter().position(|&byte| byte == 0)?;
            // The first chunk, as either version of the format names it.
            for (chunk, parent) in [("c/0/0/0", "c/0/0"), ("0/0/0", "0/0")] {
                fs::create_dir_all(folder.join(parent)).ok()?;
                fs::write(folder.join(chunk), &bytes[split + 1..]).ok()?;
            }
            fs::write(folder.join("0.0.0"), &bytes[split + 1..]).ok()?;
            fs::write(&path, &bytes[..split]).ok()?;
            return Some(folder.into());
        }
    }
    Some(path)
}

/// A layout whose numbers are the first bytes of the file.
fn raw(bytes: &[u8]) -> Option<RawLayout> {
    let (numbers, _) = bytes.split_at_checked(16)?;
    let number = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| numbers[at + i]));
    let elements = [Element::U8, Element::U16, Element::F32, Element::U64];
    Some(RawLayout {
        dims: UVec3::new(number(0), number(4), number(8)),
        element: elements[usize::from(numbers[12]) % elements.len()],
        byte_order: if numbers[13] & 1 == 0 { ByteOrder::Little } else { ByteOrder::Big },
        spacing_mm: DVec3::splat(f64::from(numbers[14])),
        header_skip_bytes: u64::from(numbers[15]),
    })
}

fn read(volume: &mut dyn VolumeReader) {
    let info = volume.info().clone();
    assert!(info.dims.min_element() > 0 && info.frame.is_sound(), "{info:?}");
    if info.bytes() > MOST_BYTES || info.dims.z > MOST_SLABS {
        return;
    }
    let mut slab = Samples::new(info.element, info.slab_voxels());
    for z in (0..info.dims.z).chain([0]) {
        if volume.read_slab(z, &mut slab).is_err() {
            return;
        }
    }
}
