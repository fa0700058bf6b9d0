//! A TIFF file in which every grey page says that black is zero, whatever the file says.
//!
//! The decoder turns numbers round where white is zero (which rounds floats, and fails on signed numbers), and
//! refuses numbers that stand for colours of a palette. The numbers themselves are what a volume wants, so the one
//! byte that says how to show them is replaced on its way to the decoder.

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
}

/// What differs between the two kinds of TIFF files, and between the byte orders.
struct Kind {
    is_big_tiff: bool,
    is_big_endian: bool,
}

impl Relabelled {
    /// Walks through the pages of a file; gives their number, too.
    pub fn open(path: &Path) -> Result<(Self, usize)> {
        let mut file = BufReader::new(File::open(path)?);
        let mut start = [0; 8];
        file.read_exact(&mut start)?;
        let kind = Kind { is_big_tiff: start.contains(&43), is_big_endian: start.starts_with(b"MM") };
        let mut next = if kind.is_big_tiff { kind.number(&mut file, 8)? } else { kind.value(&start[4..]) };
        let mut seen = HashSet::new();
        let mut replaced = Vec::new();
        while next != 0 {
            if !seen.insert(next) {
                return Err(Error::new(ErrorKind::InvalidData, "its list of pages runs in a circle"));
            }
            next = walk_page(&mut file, &kind, next, &mut replaced)?;
        }
        replaced.sort_unstable();
        file.rewind()?;
        Ok((Self { inner: file, position: 0, replaced }, seen.len()))
    }
}

/// Notes the byte to replace in the page at `start`; gives the place of the next page.
fn walk_page(file: &mut BufReader<File>, kind: &Kind, start: u64, replaced: &mut Vec<u64>) -> Result<u64> {
    let (count_bytes, word_bytes) = if kind.is_big_tiff { (8, 8) } else { (2, 4) };
    file.seek(SeekFrom::Start(start))?;
    let tags = kind.number(file, count_bytes)?;
    if tags > MOST_TAGS {
        return Err(Error::new(ErrorKind::InvalidData, format!("a page of {tags} tags")));
    }
    let mut page = vec![0; tags as usize * (4 + 2 * word_bytes)];
    file.read_exact(&mut page)?;
    for (i, tag) in page.chunks_exact(4 + 2 * word_bytes).enumerate() {
        let value = &tag[4 + word_bytes..][..2];
        let is_grey = matches!(kind.value(value), WHITE_IS_ZERO | PALETTE);
        if kind.value(&tag[..2]) == PHOTOMETRIC_TAG && is_grey {
            let before = count_bytes + i * tag.len() + 4 + word_bytes;
            replaced.push(start + before as u64 + u64::from(kind.is_big_endian));
        }
    }
    kind.number(file, word_bytes)
}

impl Kind {
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
