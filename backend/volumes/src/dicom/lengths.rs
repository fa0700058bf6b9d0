//! Whether the elements of a DICOM file end within it.
//!
//! The parser takes memory for an element before it reads the element, and a damaged length can be 4 GiB: so the
//! lengths are looked at first, without reading values.

use super::syntax::{BIG_ENDIAN, MAGIC, PREAMBLE_BYTES};
use bricks::volume::VolumeError;
use dicom_dictionary_std::uids;
use flate2::read::DeflateDecoder;
use std::fs::File;
use std::io::{BufReader, Cursor, ErrorKind, Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Length of an element that ends with a delimiter (PS3.5, 7.1.1).
const UNDEFINED: u32 = u32::MAX;
/// Types whose length has two bytes; the other ones have four, after two of no meaning (PS3.5, 7.1.2).
const SHORT: [&[u8; 2]; 21] = [
    b"AE", b"AS", b"AT", b"CS", b"DA", b"DS", b"DT", b"FL", b"FD", b"IS", b"LO", b"LT", b"PN", b"SH", b"SL",
    b"SS", b"ST", b"TM", b"UI", b"UL", b"US",
];
const META_GROUP: u16 = 0x0002;
const META_LENGTH: u16 = 0x0000;
const TRANSFER_SYNTAX: u16 = 0x0010;
const ITEM_GROUP: u16 = 0xFFFE;
const PIXEL_GROUP: u16 = 0x7FE0;
/// Bytes of a deflated data set that are believed: it is unpacked whole to be looked at.
const MOST_UNPACKED_BYTES: u64 = 1 << 30;
/// First bytes of an item, lowest byte first.
const ITEM_START: [u8; 4] = [0xfe, 0xff, 0x00, 0xe0];

/// How element headers are written.
#[derive(Clone, Copy)]
struct Coding {
    is_explicit: bool,
    is_big_endian: bool,
}

/// What stands before a value.
struct Header {
    group: u16,
    element: u16,
    vr: [u8; 2],
    length: u32,
}

struct Walk<F> {
    file: F,
    coding: Coding,
    end: u64,
    /// Whether items are pixels, and not lists of elements.
    in_pixels: bool,
}

/// Checks a file, with its preamble or without.
pub(super) fn check(path: &Path, has_preamble: bool) -> std::result::Result<(), VolumeError> {
    let file = File::open(path).map_err(VolumeError::open(path))?;
    let end = file.metadata().map_err(VolumeError::open(path))?.len();
    let preamble = if has_preamble { PREAMBLE_BYTES } else { 0 };
    let coding = Coding { is_explicit: true, is_big_endian: false };
    let mut walk = Walk { file: BufReader::new(file), coding, end, in_pixels: false };
    match walk.run((preamble + MAGIC.len()) as u64, true) {
        // A header that is cut off is for the parser to complain of.
        Err(cause) if cause.kind() == ErrorKind::UnexpectedEof => Ok(()),
        Err(cause) => Err(VolumeError::read(path)(cause)),
        Ok(None) => Ok(()),
        Ok(Some(what)) => Err(VolumeError::header(path, what)),
    }
}

fn coding(syntax: &str) -> Coding {
    let is_explicit = syntax != uids::IMPLICIT_VR_LITTLE_ENDIAN;
    Coding { is_explicit, is_big_endian: syntax == BIG_ENDIAN }
}

impl<F: Read + Seek> Walk<F> {
    /// What is wrong with the elements from a place on, if anything is; `in_meta` where the meta group comes first.
    fn run(&mut self, start: u64, mut in_meta: bool) -> Result<Option<String>> {
        self.file.seek(SeekFrom::Start(start))?;
        // The meta group is always coded in the same way, and says how long it is and how the rest is coded.
        let (mut meta_end, mut syntax) = (None, String::new());
        while self.file.stream_position()? < self.end {
            if in_meta && self.is_after_meta(meta_end)? {
                in_meta = false;
                if syntax == uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN {
                    return self.run_deflated();
                }
                self.coding = coding(&syntax);
            }
            let header = self.header()?;
            if let Some(what) = self.too_long(&header)? {
                return Ok(Some(what));
            }
            match (header.group, header.element) {
                (META_GROUP, META_LENGTH) if in_meta && header.length == 4 => {
                    let length = self.number::<4>()?;
                    meta_end = Some(self.file.stream_position()? + u64::from(length));
                }
                (META_GROUP, TRANSFER_SYNTAX) if in_meta && header.length != UNDEFINED => {
                    let mut text = vec![0; header.length as usize];
                    self.file.read_exact(&mut text)?;
                    syntax = String::from_utf8_lossy(&text).trim_end_matches(['\0', ' ']).to_owned();
                }
                _ if !self.go_into(&header)? => return Ok(None),
                _ => (),
            }
        }
        Ok(None)
    }

    fn is_after_meta(&mut self, meta_end: Option<u64>) -> Result<bool> {
        match meta_end {
            Some(end) => Ok(self.file.stream_position()? >= end),
            None => Ok(self.peek()?[..2] != META_GROUP.to_le_bytes()),
        }
    }

    /// What is wrong with the elements that the rest of the file unpacks to.
    fn run_deflated(&mut self) -> Result<Option<String>> {
        let mut unpacked = Vec::new();
        // What comes before damage can still be wrong; the damage itself is for the parser to complain of.
        let _ = DeflateDecoder::new(&mut self.file).take(MOST_UNPACKED_BYTES + 1).read_to_end(&mut unpacked);
        let end = unpacked.len() as u64;
        if end > MOST_UNPACKED_BYTES {
            let what = "its deflated elements unpack to more than 1 GiB: unpack it first, for instance with gdcmconv --raw";
            return Ok(Some(what.into()));
        }
        let coding = Coding { is_explicit: true, is_big_endian: false };
        Walk { file: Cursor::new(unpacked), coding, end, in_pixels: false }.run(0, false)
    }

    fn too_long(&mut self, header: &Header) -> Result<Option<String>> {
        let left = self.end.saturating_sub(self.file.stream_position()?);
        let is_wrong = header.length != UNDEFINED && u64::from(header.length) > left;
        Ok(is_wrong.then(|| {
            format!(
                "element ({:04x},{:04x}) has {} bytes, and {left} are left: the file is cut off or damaged, copy it again",
                header.group, header.element, header.length
            )
        }))
    }

    /// Goes to the next header, in the value where that is made of elements; false if that is unknown.
    fn go_into(&mut self, header: &Header) -> Result<bool> {
        let is_item = header.group == ITEM_GROUP;
        if header.length == UNDEFINED {
            self.in_pixels |= header.group == PIXEL_GROUP;
            // What is in a value of unknown type is coded otherwise.
            return Ok(header.vr != *b"UN");
        }
        let is_list = match (is_item, self.coding.is_explicit) {
            (true, _) => !self.in_pixels,
            (false, true) => header.vr == *b"SQ",
            (false, false) => header.length >= 8 && self.peek()? == ITEM_START,
        };
        if !is_list {
            self.file.seek_relative(i64::from(header.length))?;
        }
        Ok(true)
    }

    fn header(&mut self) -> Result<Header> {
        let (group, element) = (self.number::<2>()? as u16, self.number::<2>()? as u16);
        let mut header = Header { group, element, vr: [0; 2], length: 0 };
        if group == ITEM_GROUP || !self.coding.is_explicit {
            header.length = self.number::<4>()?;
            return Ok(header);
        }
        self.file.read_exact(&mut header.vr)?;
        header.length = self.number::<2>()?;
        if !SHORT.contains(&&header.vr) {
            header.length = self.number::<4>()?;
        }
        Ok(header)
    }

    fn number<const BYTES: usize>(&mut self) -> Result<u32> {
        let mut bytes = [0; BYTES];
        self.file.read_exact(&mut bytes)?;
        if !self.coding.is_big_endian {
            bytes.reverse();
        }
        Ok(bytes.iter().fold(0, |number, &byte| number << 8 | u32::from(byte)))
    }

    /// The next bytes, which stay.
    fn peek(&mut self) -> Result<[u8; 4]> {
        let mut bytes = [0; 4];
        self.file.read_exact(&mut bytes)?;
        self.file.seek_relative(-4)?;
        Ok(bytes)
    }
}
