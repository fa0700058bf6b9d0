//! Whether the elements of a DICOM file end within it, and do not lie too deep in each other.
//!
//! The parser takes memory for an element before it reads the element, and a damaged length can be 4 GiB; and it goes
//! into sequences by recursion. So lengths and sequences are looked at first, without reading values, and just as the
//! parser will understand them: a file that it understands otherwise would slip through.

use super::start::Start;
use super::syntax::{BIG_ENDIAN, MAGIC};
use bricks::volume::{VolumeError, open_file};
use dicom_core::dictionary::{DataDictionary, DataDictionaryEntry};
use dicom_core::{Tag, VR};
use dicom_dictionary_std::{StandardDataDictionary, uids};
use flate2::read::DeflateDecoder;
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
const ITEM: Tag = Tag(ITEM_GROUP, 0xE000);
const ITEM_END: Tag = Tag(ITEM_GROUP, 0xE00D);
const SEQUENCE_END: Tag = Tag(ITEM_GROUP, 0xE0DD);
const PIXELS: Tag = Tag(0x7FE0, 0x0010);
/// Groups 6000 to 60FF, and their element with pixels.
const OVERLAYS: u16 = 0x60;
const OVERLAY: u16 = 0x3000;
/// Bytes of a deflated data set that are believed: it is unpacked whole to be looked at.
const MOST_UNPACKED_BYTES: u64 = 1 << 30;
/// Sequences within each other that are believed; reports, the deepest of all, have some ten.
const DEEPEST: usize = 64;
/// Transfer syntaxes whose elements are deflated.
const DEFLATED: [&str; 3] = [
    uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN,
    uids::JPIP_REFERENCED_DEFLATE,
    uids::JPIPHTJ2K_REFERENCED_DEFLATE,
];

/// How element headers are written.
#[derive(Clone, Copy)]
struct Coding {
    is_explicit: bool,
    is_big_endian: bool,
}

/// What stands before a value.
struct Header {
    tag: Tag,
    vr: [u8; 2],
    length: u32,
}

/// A sequence, or an item of one, that has begun.
struct Begun {
    is_item: bool,
    /// Where it ends; None if a delimiter ends it.
    end: Option<u64>,
    /// Whether its items are pixels, not lists of elements.
    is_of_pixels: bool,
}

struct Walk<F> {
    file: F,
    position: u64,
    end: u64,
    coding: Coding,
    begun: Vec<Begun>,
    /// Whether an item comes next, not an element.
    awaits_item: bool,
}

/// Why a walk ended early.
enum Fault {
    Unreadable(std::io::Error),
    Wrong(String),
}

impl From<std::io::Error> for Fault {
    fn from(cause: std::io::Error) -> Self {
        Self::Unreadable(cause)
    }
}

/// Checks a file.
pub(super) fn check(path: &Path, start: Start) -> std::result::Result<(), VolumeError> {
    let file = open_file(path).map_err(VolumeError::open(path))?;
    let end = file.metadata().map_err(VolumeError::open(path))?.len();
    match Walk::new(BufReader::new(file), end).run(start) {
        // A header that is cut off is for the parser to complain of.
        Err(Fault::Unreadable(cause)) if cause.kind() == ErrorKind::UnexpectedEof => Ok(()),
        Err(Fault::Unreadable(cause)) => Err(VolumeError::read(path)(cause)),
        Err(Fault::Wrong(what)) => Err(VolumeError::header(path, what)),
        Ok(()) => Ok(()),
    }
}

/// Whether a value is whole numbers of its type: the parser reads no others, and would take what is left for the next element.
fn check_width(header: &Header, vr: VR) -> std::result::Result<(), Fault> {
    let width = match vr {
        VR::US | VR::SS | VR::OW => 2,
        VR::AT | VR::UL | VR::SL | VR::OL | VR::FL | VR::OF => 4,
        VR::UV | VR::SV | VR::OV | VR::FD | VR::OD => 8,
        _ => 1,
    };
    if header.length == UNDEFINED || header.length.is_multiple_of(width) {
        return Ok(());
    }
    Err(Fault::Wrong(format!(
        "element ({:04x},{:04x}) has {} bytes, but its numbers have {width} each: the file is damaged, copy it again",
        header.tag.group(),
        header.tag.element(),
        header.length
    )))
}

fn coding(syntax: &str) -> Coding {
    let is_explicit = syntax != uids::IMPLICIT_VR_LITTLE_ENDIAN;
    Coding { is_explicit, is_big_endian: syntax == BIG_ENDIAN }
}

impl<F: Read + Seek> Walk<F> {
    fn new(file: F, end: u64) -> Self {
        let coding = Coding { is_explicit: true, is_big_endian: false };
        Self { file, position: 0, end, coding, begun: Vec::new(), awaits_item: false }
    }

    fn run(&mut self, start: Start) -> std::result::Result<(), Fault> {
        match start {
            Start::Elements { syntax } => self.coding = coding(syntax),
            Start::Meta => return self.run_after_meta(),
            Start::Whole { preamble_bytes } => {
                self.position = (preamble_bytes + MAGIC.len()) as u64;
                self.file.seek(SeekFrom::Start(self.position))?;
                return self.run_after_meta();
            }
        }
        self.elements()
    }

    fn run_after_meta(&mut self) -> std::result::Result<(), Fault> {
        let syntax = self.meta()?;
        if DEFLATED.contains(&&*syntax) {
            return self.run_deflated();
        }
        self.coding = coding(&syntax);
        self.elements()
    }

    /// Goes through the meta group, which is always coded in the same way, and says how long it is and how the rest is
    /// coded.
    fn meta(&mut self) -> std::result::Result<String, Fault> {
        let (mut meta_end, mut syntax) = (None, String::new());
        while self.position < meta_end.unwrap_or(self.end) {
            let header = self.header()?;
            self.check_length(&header)?;
            match (header.tag.group(), header.tag.element()) {
                (META_GROUP, META_LENGTH) if meta_end.is_none() && header.length == 4 => {
                    let length = self.number::<4>()?;
                    meta_end = Some(self.position + u64::from(length));
                }
                (META_GROUP, TRANSFER_SYNTAX) if header.length != UNDEFINED => {
                    let mut text = vec![0; header.length as usize];
                    self.read(&mut text)?;
                    let text = String::from_utf8_lossy(&text);
                    syntax = text.trim_end_matches(|c: char| c.is_whitespace() || c == '\0').to_owned();
                }
                _ if header.length == UNDEFINED => {
                    return Err(Fault::Unreadable(ErrorKind::UnexpectedEof.into()));
                }
                _ => self.skip(header.length)?,
            }
        }
        Ok(syntax)
    }

    /// Goes through the elements that the rest of the file unpacks to.
    fn run_deflated(&mut self) -> std::result::Result<(), Fault> {
        let mut unpacked = Vec::new();
        // What comes before damage can still be wrong; the damage itself is for the parser to complain of.
        let _ = DeflateDecoder::new(&mut self.file).take(MOST_UNPACKED_BYTES + 1).read_to_end(&mut unpacked);
        let end = unpacked.len() as u64;
        if end > MOST_UNPACKED_BYTES {
            let what = "its deflated elements unpack to more than 1 GiB: unpack it first, for instance with gdcmconv --raw";
            return Err(Fault::Wrong(what.into()));
        }
        Walk::new(Cursor::new(unpacked), end).elements()
    }

    /// Goes through elements to the end, or to what the parser will not go beyond.
    fn elements(&mut self) -> std::result::Result<(), Fault> {
        while self.position < self.end {
            self.end_what_is_over()?;
            let goes_on = if self.awaits_item { self.item()? } else { self.element()? };
            if !goes_on {
                break;
            }
        }
        Ok(())
    }

    /// Leaves the sequences and items whose length is over.
    fn end_what_is_over(&mut self) -> std::result::Result<(), Fault> {
        while let Some(&Begun { is_item, end: Some(end), .. }) = self.begun.last() {
            if self.position < end {
                break;
            }
            if self.position > end {
                let what =
                    "the lengths of its sequences contradict each other: it may be damaged, copy it again";
                return Err(Fault::Wrong(what.into()));
            }
            self.begun.pop();
            self.awaits_item = is_item;
        }
        Ok(())
    }

    /// The header of an item, or the end of one or of a sequence; false where there is neither.
    fn item(&mut self) -> std::result::Result<bool, Fault> {
        let (tag, length) = (self.tag()?, self.number::<4>()?);
        let is_of_pixels = self.begun.last().is_some_and(|begun| begun.is_of_pixels);
        match tag {
            ITEM if is_of_pixels && length == UNDEFINED => return Ok(false),
            ITEM => {
                self.check_length(&Header { tag, vr: [0; 2], length })?;
                match is_of_pixels {
                    true => self.skip(length)?,
                    false => self.begin(true, length, false)?,
                }
            }
            ITEM_END | SEQUENCE_END => {
                self.begun.pop();
                self.awaits_item = tag == ITEM_END;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The header of an element, and its value if that is not made of elements; or the end of an item.
    fn element(&mut self) -> std::result::Result<bool, Fault> {
        let header = self.header()?;
        if header.tag == ITEM_END {
            self.awaits_item = self.begun.pop().is_some();
            return Ok(true);
        }
        self.check_length(&header)?;
        let vr = self.vr(&header);
        check_width(&header, vr)?;
        let is_sequence = vr == VR::SQ;
        match is_sequence || header.length == UNDEFINED {
            true => self.begin(false, header.length, header.tag == PIXELS && !is_sequence)?,
            false => self.skip(header.length)?,
        }
        Ok(true)
    }

    /// The type as the parser takes it; without types in the file, the dictionary says it.
    fn vr(&self, header: &Header) -> VR {
        let Tag(group, element) = header.tag;
        if self.coding.is_explicit {
            return VR::from_binary(header.vr).unwrap_or(VR::UN);
        }
        if header.tag == PIXELS || (group >> 8 == OVERLAYS && element == OVERLAY) {
            return VR::OW;
        }
        StandardDataDictionary.by_tag(header.tag).map_or(VR::UN, |entry| entry.vr().relaxed())
    }

    fn begin(&mut self, is_item: bool, length: u32, is_of_pixels: bool) -> std::result::Result<(), Fault> {
        if self.begun.len() == 2 * DEEPEST {
            let what = format!(
                "its sequences lie more than {DEEPEST} deep in each other: it may be damaged, copy it again"
            );
            return Err(Fault::Wrong(what));
        }
        let end = (length != UNDEFINED).then(|| self.position + u64::from(length));
        self.begun.push(Begun { is_item, end, is_of_pixels });
        self.awaits_item = !is_item;
        Ok(())
    }

    /// Whether what a header announces ends within the file.
    fn check_length(&self, header: &Header) -> std::result::Result<(), Fault> {
        let left = self.end.saturating_sub(self.position);
        if header.length == UNDEFINED || u64::from(header.length) <= left {
            return Ok(());
        }
        Err(Fault::Wrong(format!(
            "element ({:04x},{:04x}) has {} bytes, and {left} are left: the file is cut off or damaged, copy it again",
            header.tag.group(),
            header.tag.element(),
            header.length
        )))
    }

    fn header(&mut self) -> Result<Header> {
        let mut header = Header { tag: self.tag()?, vr: [0; 2], length: 0 };
        if header.tag.group() == ITEM_GROUP || !self.coding.is_explicit {
            header.length = self.number::<4>()?;
            return Ok(header);
        }
        let mut vr = [0; 2];
        self.read(&mut vr)?;
        header.vr = vr;
        header.length = self.number::<2>()?;
        if !SHORT.contains(&&header.vr) {
            header.length = self.number::<4>()?;
        }
        Ok(header)
    }

    fn tag(&mut self) -> Result<Tag> {
        Ok(Tag(self.number::<2>()? as u16, self.number::<2>()? as u16))
    }

    fn number<const BYTES: usize>(&mut self) -> Result<u32> {
        let mut bytes = [0; BYTES];
        self.read(&mut bytes)?;
        if !self.coding.is_big_endian {
            bytes.reverse();
        }
        Ok(bytes.iter().fold(0, |number, &byte| number << 8 | u32::from(byte)))
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<()> {
        self.file.read_exact(bytes)?;
        self.position += bytes.len() as u64;
        Ok(())
    }

    fn skip(&mut self, bytes: u32) -> Result<()> {
        self.file.seek_relative(i64::from(bytes))?;
        self.position += u64::from(bytes);
        Ok(())
    }
}
