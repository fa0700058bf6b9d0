//! A TIFF file in which every grey page says that black is zero, whatever the file says.
//!
//! The decoder turns numbers round where white is zero (which rounds floats, and fails on signed numbers), and
//! refuses numbers that stand for colours of a palette. The numbers themselves are what a volume wants, so the one
//! byte that says how to show them is replaced on its way to the decoder.

use bricks::volume::open_file;
use std::collections::HashSet;
use std::fs::File;
use std::io::{BufReader, Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Photometric interpretations (TIFF 6.0, page 37), as the file's tag of that name holds them.
const PHOTOMETRIC_TAG: u64 = 262;
const WHITE_IS_ZERO: u64 = 0;
const BLACK_IS_ZERO: u8 = 1;
const PALETTE: u64 = 3;
/// No page has more tags: there are not so many numbers for them.
const MOST_TAGS: u64 = 1 << 16;

/// Bytes of a file, but for those that are replaced.
pub(super) struct Relabelled {
    inner: BufReader<File>,
    position: u64,
    /// Places of replaced bytes, in order.
    replaced: Vec<u64>,
    /// Whether the numbers of a page stand for the colours of a palette.
    pub has_palette: bool,
}

/// What differs between the two kinds of TIFF files, and between the byte orders.
struct Kind {
    is_big_tiff: bool,
    is_big_endian: bool,
}

impl Relabelled {
    /// Walks through the pages of a file; gives their number, too.
    pub fn open(path: &Path) -> Result<(Self, usize)> {
        let file = open_file(path)?;
        let length = file.metadata()?.len();
        let mut file = BufReader::new(file);
        let mut start = [0; 8];
        file.read_exact(&mut start)?;
        let kind = Kind { is_big_tiff: start.contains(&43), is_big_endian: start.starts_with(b"MM") };
        let mut next = if kind.is_big_tiff { kind.number(&mut file, 8)? } else { kind.value(&start[4..]) };
        let mut seen = HashSet::new();
        let (mut replaced, mut has_palette) = (Vec::new(), false);
        // Bytes that the tags of further pages can take: they do not overlap.
        let mut left = length;
        while next != 0 {
            if !seen.insert(next) {
                return Err(wrong("its list of pages runs in a circle"));
            }
            let page = Page::read(&mut file, &kind, next)?;
            page.check(&kind, length)?;
            left = left.checked_sub(page.tags.len() as u64).ok_or_else(|| wrong("its pages overlap"))?;
            replaced.extend(page.replaced(&kind));
            has_palette |= page.photometric(&kind) == Some(PALETTE);
            next = page.next;
        }
        replaced.sort_unstable();
        file.rewind()?;
        Ok((Self { inner: file, position: 0, replaced, has_palette }, seen.len()))
    }
}

/// What a page says of itself.
struct Page {
    start: u64,
    /// So many bytes each: number, type, count of values, and the values or their place.
    tags: Vec<u8>,
    /// Place of the next page; 0 if there is none.
    next: u64,
}

impl Page {
    fn read(file: &mut BufReader<File>, kind: &Kind, start: u64) -> Result<Self> {
        file.seek(SeekFrom::Start(start))?;
        let count = kind.number(file, kind.count_bytes())?;
        if count > MOST_TAGS {
            return Err(wrong(format!("a page of {count} tags")));
        }
        let mut tags = vec![0; count as usize * kind.tag_bytes()];
        file.read_exact(&mut tags)?;
        Ok(Self { start, tags, next: kind.number(file, kind.word_bytes())? })
    }

    /// The decoder takes memory for the values of a tag before it looks for them.
    fn check(&self, kind: &Kind, length: u64) -> Result<()> {
        for tag in self.tags.chunks_exact(kind.tag_bytes()) {
            let values = kind.value(&tag[4..][..kind.word_bytes()]);
            if values > length {
                let number = kind.value(&tag[..2]);
                return Err(wrong(format!("tag {number} has {values} values, and the file {length} bytes")));
            }
        }
        Ok(())
    }

    /// What its numbers mean, as far as it says so.
    fn photometric(&self, kind: &Kind) -> Option<u64> {
        let mut tags = self.tags.chunks_exact(kind.tag_bytes());
        let tag = tags.find(|tag| kind.value(&tag[..2]) == PHOTOMETRIC_TAG)?;
        Some(kind.value(&tag[4 + kind.word_bytes()..][..2]))
    }

    /// Places of the bytes to replace.
    fn replaced(&self, kind: &Kind) -> impl Iterator<Item = u64> {
        let value_at = 4 + kind.word_bytes();
        let is_replaced = move |tag: &[u8]| {
            let is_grey = matches!(kind.value(&tag[value_at..][..2]), WHITE_IS_ZERO | PALETTE);
            kind.value(&tag[..2]) == PHOTOMETRIC_TAG && is_grey
        };
        let tags = self.tags.chunks_exact(kind.tag_bytes()).enumerate();
        let found = tags.filter(move |(_, tag)| is_replaced(tag));
        found.map(move |(i, tag)| {
            let before = kind.count_bytes() + i * tag.len() + value_at;
            self.start + before as u64 + u64::from(kind.is_big_endian)
        })
    }
}

fn wrong(what: impl Into<String>) -> Error {
    Error::new(ErrorKind::InvalidData, what.into())
}

impl Kind {
    /// Bytes of the number of tags.
    fn count_bytes(&self) -> usize {
        if self.is_big_tiff { 8 } else { 2 }
    }

    /// Bytes of a place in the file, and of a count of values.
    fn word_bytes(&self) -> usize {
        if self.is_big_tiff { 8 } else { 4 }
    }

    fn tag_bytes(&self) -> usize {
        4 + 2 * self.word_bytes()
    }

    fn value(&self, bytes: &[u8]) -> u64 {
        let push = |value: u64, &byte: &u8| value << 8 | u64::from(byte);
        match self.is_big_endian {
            true => bytes.iter().fold(0, push),
            false => bytes.iter().rev().fold(0, push),
        }
    }

    fn number(&self, file: &mut impl Read, bytes: usize) -> Result<u64> {
        let mut number = [0; 8];
        file.read_exact(&mut number[..bytes])?;
        Ok(self.value(&number[..bytes]))
    }
}

impl Read for Relabelled {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let read = self.inner.read(buffer)?;
        let (start, end) = (self.position, self.position + read as u64);
        let first = self.replaced.partition_point(|&place| place < start);
        for place in self.replaced[first..].iter().take_while(|&&place| place < end) {
            buffer[(place - start) as usize] = BLACK_IS_ZERO;
        }
        self.position = end;
        Ok(read)
    }
}

impl Seek for Relabelled {
    fn seek(&mut self, place: SeekFrom) -> Result<u64> {
        self.position = self.inner.seek(place)?;
        Ok(self.position)
    }
}
