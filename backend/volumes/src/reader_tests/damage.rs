//! Files that are cut short, damaged, or no volumes at all.

use super::*;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

/// What is said of a file with these bytes.
pub fn complaint(name: &str, bytes: &[u8]) -> String {
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
    for name in [
        "short.nrrd",
        "ushort_gzip.nrrd",
        "int32_ascii.nrrd",
        "ushort_zlib.mha",
        "double.mha",
        "text.mha",
        "ushort.nii",
        "short_big.nii.gz",
        "nifti2.nii.gz",
        "nifti2_big.nii",
    ] {
        let bytes = std::fs::read(data(name)).unwrap();
        // Nothing but a checksum tells that the last number of a text is cut short.
        let is_packed = name.contains("gz") || name.contains("zlib");
        let last = bytes.len() - 18..if is_packed { bytes.len() } else { bytes.len() - 18 };
        for length in (0..bytes.len() - 18).step_by(7).chain(last) {
            complaint(name, &bytes[..length]);
        }
    }
}

/// A packed file of voxels that stay the same when a bit of it changes: only its checksum tells.
#[test]
fn the_checksum_of_a_packed_file_is_looked_at() {
    for (name, checksum) in [
        ("ushort_gzip.nrrd", 8),
        ("short_big.nii.gz", 8),
        ("nifti2.nii.gz", 8),
        ("ushort_zlib.mha", 4),
        ("all_uint8.mha", 4),
    ] {
        let bytes = std::fs::read(data(name)).unwrap();
        for at in bytes.len() - checksum..bytes.len() {
            let mut wrong = bytes.clone();
            wrong[at] ^= 0x20;
            let said = complaint(name, &wrong);
            assert!(said.contains("may be damaged"), "byte {at} of {name}: {said}");
        }
    }
}

/// Of several volumes in a file one is read; that another one is damaged must be found, since it may be the file that is.
#[test]
fn a_packed_file_is_read_to_its_end_whatever_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("times.nii.gz");
    let bytes = std::fs::read(data("times.nii.gz")).unwrap();
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        open(&path, &chosen(None, Some(0))).and_then(|mut reader| values(reader.as_mut()))
    };
    read(&bytes).unwrap();
    for at in bytes.len() - 8..bytes.len() {
        let mut wrong = bytes.clone();
        wrong[at] ^= 1;
        assert!(read(&wrong).unwrap_err().to_string().contains("may be damaged"), "{at}");
    }
    // Members that are whole, and fewer than the header says.
    let mut unpacked = Vec::new();
    std::io::Read::read_to_end(&mut flate2::read::MultiGzDecoder::new(&bytes[..]), &mut unpacked).unwrap();
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(&unpacked[..unpacked.len() - 1]).unwrap();
    assert!(read(&packed.finish().unwrap()).unwrap_err().to_string().contains("bytes are there"));
}

/// The header of a pair is a file of its own, of which only the start is used.
#[test]
fn the_checksum_of_a_packed_header_is_looked_at() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(data("pair.img"), folder.path().join("pair.img")).unwrap();
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(&std::fs::read(data("pair.hdr")).unwrap()).unwrap();
    let mut packed = packed.finish().unwrap();
    let path = folder.path().join("pair.hdr.gz");
    std::fs::write(&path, &packed).unwrap();
    open(&path, &Selection::default()).unwrap();
    let checksum = packed.len() - 8;
    packed[checksum] ^= 1;
    std::fs::write(&path, &packed).unwrap();
    assert!(open(&path, &Selection::default()).unwrap_err().to_string().contains("may be damaged"));
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

/// The next number of xorshift64 (Marsaglia 2003), for damage that is the same at every run.
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 16) as usize
}

/// Changes one to three bytes, where headers are.
fn damage(bytes: &mut [u8], state: &mut u64) {
    let places = bytes.len().min(600);
    for _ in 0..1 + next(state) % 3 {
        // Digits and blanks keep text headers readable more often than any byte would.
        let any = [next(state) as u8, b"0123456789 -%\n"[next(state) % 14]];
        bytes[next(state) % places] = any[next(state) % 2];
    }
}

#[test]
fn damaged_bytes_are_read_or_refused_but_never_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = 0x9e37_79b9_7f4a_7c15;
    let names = ["big_directions.nrrd", "int32_ascii.nrrd", "channels.nrrd", "list.nhdr", "numbered.nhdr"];
    let others =
        ["times.mha", "text.mha", "list.mhd", "ushort.nii", "nifti2_big.nii", "pair.hdr", "channels.mha"];
    for slice in ["slice_01.raw", "slice_02.raw", "slice_03.raw", "slice_04.raw", "pair.img"] {
        std::fs::copy(data(slice), folder.path().join(slice)).unwrap();
    }
    let (mut read, mut refused) = (0, 0);
    for name in names.into_iter().chain(others) {
        let bytes = std::fs::read(data(name)).unwrap();
        for _ in 0..60 {
            let mut damaged = bytes.clone();
            damage(&mut damaged, &mut state);
            let path = folder.path().join(name);
            std::fs::write(&path, damaged).unwrap();
            let volume = open(&path, &chosen(Some(0), Some(0)));
            match volume.and_then(|mut reader| values(reader.as_mut())) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read > 50 && refused > 50, "{read} read and {refused} refused");
}
