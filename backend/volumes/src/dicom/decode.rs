//! The bytes of a frame, extracted from its file and unpacked.

use super::header::{Frame, ImageFile, cause_of, damaged};
use super::jpeg::JpegSize;
use super::rle;
use super::syntax::{BIG_ENDIAN, is_plain};
use bricks::volume::{VolumeError, open_file};
use dicom_core::{DicomValue, Tag};
use dicom_dictionary_std::{tags, uids};
use dicom_object::{DefaultDicomObject, OpenFileOptions};
use dicom_pixeldata::PixelDecoder;
use dicom_transfer_syntax_registry::{TransferSyntaxIndex, TransferSyntaxRegistry};
use std::io::{Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// First bytes of the element of the pixels in files with and without value representations; then comes its
/// length, in four bytes (PS3.5, 7.1).
const EXPLICIT_STARTS: [&[u8]; 4] = [
    &[0xe0, 0x7f, 0x10, 0, b'O', b'W', 0, 0],
    &[0xe0, 0x7f, 0x10, 0, b'O', b'B', 0, 0],
    &[0xe0, 0x7f, 0x08, 0, b'O', b'F', 0, 0],
    &[0xe0, 0x7f, 0x09, 0, b'O', b'D', 0, 0],
];
const IMPLICIT_STARTS: [&[u8]; 3] = [&[0xe0, 0x7f, 0x10, 0], &[0xe0, 0x7f, 0x08, 0], &[0xe0, 0x7f, 0x09, 0]];
const LENGTH_BYTES: usize = 4;
/// The elements that pixels can be in, of which a file has one.
const PIXELS: [Tag; 3] = [tags::PIXEL_DATA, tags::FLOAT_PIXEL_DATA, tags::DOUBLE_FLOAT_PIXEL_DATA];

/// Whether the frames can be unpacked.
pub(super) fn check(file: &ImageFile) -> Result<(), VolumeError> {
    let syntax = TransferSyntaxRegistry.get(&file.transfer_syntax);
    let name = match syntax {
        Some(syntax) if syntax.can_decode_all() => return check_bytes(file),
        Some(syntax) => syntax.name(),
        None => "an unknown syntax",
    };
    let what = format!(
        "its pixels are packed as {name} (transfer syntax {}); unpack the files first, for instance with gdcmconv --raw",
        file.transfer_syntax
    );
    Err(VolumeError::unsupported(&file.path, what))
}

/// The crate swaps the bytes of pairs, which is all of a number of 16 bits but not of 32.
fn check_bytes(file: &ImageFile) -> Result<(), VolumeError> {
    if file.transfer_syntax == BIG_ENDIAN && file.pixels.allocated > 16 {
        let what = "it has pixels of 32 bits, highest byte first: convert it to Explicit VR Little Endian";
        return Err(VolumeError::unsupported(&file.path, what));
    }
    Ok(())
}

/// Reads frames, keeping the file of the last one where there is more in it.
pub(super) struct Decoder {
    /// Most bytes of a file that is kept.
    memory_bytes: u64,
    kept: Option<(PathBuf, DefaultDicomObject)>,
}

impl Decoder {
    /// Keeps files of up to so many bytes.
    pub fn new(memory_bytes: u64) -> Self {
        Self { memory_bytes, kept: None }
    }

    /// The cells of a frame, lowest byte first: as many bytes as [`Frame::bytes`] says.
    pub fn frame(&mut self, frame: &Frame) -> Result<Vec<u8>, VolumeError> {
        let file = &*frame.file;
        if is_plain(&file.transfer_syntax)
            && let Some(bytes) = frame_in_place(frame).map_err(VolumeError::read(&file.path))?
        {
            return Ok(bytes);
        }
        let bytes = unpack(self.object(file)?, frame)?;
        if bytes.len() == frame.bytes() {
            return Ok(bytes);
        }
        let found = format!("{} has {}", frame.name(), bytes.len());
        Err(VolumeError::Truncated { path: file.path.clone(), promised: frame.bytes() as u64, found })
    }

    fn object(&mut self, file: &ImageFile) -> Result<&DefaultDicomObject, VolumeError> {
        if self.kept.as_ref().is_none_or(|(path, _)| *path != file.path) {
            self.kept = None;
            if file.length > self.memory_bytes {
                let what = format!(
                    "its frames are packed in one file of {} bytes, and {} of memory are allowed: allow more, or unpack it \
                     first, for instance with gdcmconv --raw",
                    file.length, self.memory_bytes
                );
                return Err(VolumeError::unsupported(&file.path, what));
            }
            let stream = file.start.open(&file.path).map_err(VolumeError::open(&file.path))?;
            let object = OpenFileOptions::new().from_reader(stream);
            self.kept = Some((file.path.clone(), object.map_err(|cause| damaged(&file.path, &cause))?));
        }
        Ok(&self.kept.as_ref().expect("it was put there above").1)
    }
}

/// The frame where the pixels are the last element of the file, as they nearly always are; otherwise None.
fn frame_in_place(frame: &Frame) -> std::io::Result<Option<Vec<u8>>> {
    let file = &*frame.file;
    let bytes = frame.bytes() as u64;
    // Elements have an even length.
    let all = (bytes * u64::from(file.frames)).next_multiple_of(2);
    let starts: &[&[u8]] = match file.transfer_syntax.as_str() {
        uids::IMPLICIT_VR_LITTLE_ENDIAN => &IMPLICIT_STARTS,
        _ => &EXPLICIT_STARTS,
    };
    let mut header = vec![0; starts[0].len() + LENGTH_BYTES];
    let (Some(at), Ok(length)) = (file.length.checked_sub(all + header.len() as u64), u32::try_from(all))
    else {
        return Ok(None);
    };
    let mut stream = open_file(&file.path)?;
    stream.seek(SeekFrom::Start(at))?;
    stream.read_exact(&mut header)?;
    let is_there = |start: &&[u8]| header == [start, &length.to_le_bytes()[..]].concat();
    if !starts.iter().any(is_there) {
        return Ok(None);
    }
    let mut cells = vec![0; frame.bytes()];
    stream.seek_relative((bytes * u64::from(frame.index)) as i64)?;
    stream.read_exact(&mut cells)?;
    Ok(Some(cells))
}

fn unpack(object: &DefaultDicomObject, frame: &Frame) -> Result<Vec<u8>, VolumeError> {
    let file = &*frame.file;
    let wrong =
        |what: &str| VolumeError::unsupported(&file.path, format!("{} {what}: copy it again", frame.name()));
    let mut pixels = PIXELS.into_iter().filter_map(|tag| object.get(tag));
    let pixels = pixels.next().ok_or_else(|| wrong("has no pixels"))?;
    match pixels.value() {
        DicomValue::Primitive(cells) => {
            let start = frame.bytes() * frame.index as usize;
            let cells = cells.to_bytes();
            let cells = cells.get(start..).unwrap_or_default();
            Ok(cells[..cells.len().min(frame.bytes())].to_vec())
        }
        DicomValue::PixelSequence(sequence) if file.transfer_syntax == uids::RLE_LOSSLESS => {
            // The crate's own decoder panics where the runs end early.
            let packed = sequence.fragments().get(frame.index as usize).ok_or_else(|| wrong("is missing"))?;
            let pixels = file.rows as usize * file.columns as usize;
            rle::unpack(packed, pixels, usize::from(file.pixels.allocated / 8))
                .ok_or_else(|| wrong("has damaged runs"))
        }
        DicomValue::PixelSequence(sequence) => {
            check_sizes(sequence.fragments(), frame)?;
            unpack_jpeg(object, frame)
        }
        DicomValue::Sequence(_) => Err(wrong("has no pixels")),
    }
}

/// The crate copies what a JPEG holds to where the frame has room, and panics where the JPEG is the larger: so what the
/// JPEGs say of their sizes must fit.
fn check_sizes(fragments: &[Vec<u8>], frame: &Frame) -> Result<(), VolumeError> {
    let (file, room) = (&*frame.file, frame.bytes() as u64);
    // A fragment that goes on with the one before it has no size.
    let sizes = fragments.iter().filter_map(|fragment| JpegSize::of(fragment));
    let Some(wrong) = sizes
        .into_iter()
        .find(|size| (size.rows, size.columns) != (file.rows, file.columns) || size.bytes() > room)
    else {
        return Ok(());
    };
    let JpegSize { rows, columns, components, bits } = wrong;
    let what = format!(
        "it holds a JPEG of {columns} × {rows} pixels of {components} × {bits} bits, and its header says {} × {} of {}: \
         copy it again",
        file.columns, file.rows, file.pixels.allocated
    );
    Err(VolumeError::unsupported(&file.path, what))
}

/// Sizes that cannot be seen beforehand may still make the crate panic.
fn unpack_jpeg(object: &DefaultDicomObject, frame: &Frame) -> Result<Vec<u8>, VolumeError> {
    let path = &frame.file.path;
    let unpack = || object.decode_pixel_data_frame(frame.index).map(|pixels| pixels.data().to_vec());
    match catch_unwind(AssertUnwindSafe(unpack)) {
        Ok(Ok(cells)) => Ok(cells),
        Ok(Err(cause)) => {
            let cause = cause_of(&cause);
            let what =
                format!("{}: {cause}; unpack it first, for instance with gdcmconv --raw", frame.name());
            Err(VolumeError::unsupported(path, what))
        }
        Err(_) => {
            let what = format!("{} is not of the size that the header says: copy it again", frame.name());
            Err(VolumeError::unsupported(path, what))
        }
    }
}
