//! The unpacked bytes of a volume's files, as if they were one.

use super::data_files::DataFiles;
use super::gzip::Gzip;
use super::packing::Packing;
use super::text_numbers::TextNumbers;
use bricks::volume::{Element, open_file};
use flate2::bufread::ZlibDecoder;
use std::fs::File;
use std::io::{BufRead, BufReader, Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Bytes read from a file at once.
const READ_BUFFER_BYTES: usize = 1 << 18;

/// What precedes the voxels, in each of the files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Start {
    /// Bytes of the file, as it is.
    pub header_bytes: u64,
    /// Lines after these, as they are in the file.
    pub lines: u32,
    /// Bytes after these, once unpacked.
    pub unpacked_bytes: u64,
    /// Whether the voxels end with the file, whatever precedes them; only of [`Packing::Plain`].
    pub is_from_end: bool,
}

/// The files and how to read them.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub files: DataFiles,
    pub start: Start,
    pub packing: Packing,
    pub element: Element,
    /// Bytes of voxels in each file, unpacked.
    pub file_bytes: u64,
}

impl Source {
    /// Bytes of a file before its (packed) voxels.
    pub fn offset(&self, path: &Path) -> Result<u64> {
        let start = &self.start;
        if start.is_from_end {
            return Ok(std::fs::metadata(path)?.len().saturating_sub(self.file_bytes));
        }
        if start.lines == 0 {
            return Ok(start.header_bytes);
        }
        let mut file = BufReader::new(open_file(path)?);
        let mut offset = file.seek(SeekFrom::Start(start.header_bytes))?;
        for _ in 0..start.lines {
            match file.skip_until(b'\n')? {
                0 => break,
                skipped => offset += skipped as u64,
            }
        }
        Ok(offset)
    }

    fn open(&self, path: &Path) -> Result<Unpacked> {
        let offset = self.offset(path)?;
        let start = match self.packing {
            Packing::Plain | Packing::Text => offset.saturating_add(self.start.unpacked_bytes),
            Packing::Gzip | Packing::Zlib => offset,
        };
        let mut file = open_file(path)?;
        file.seek(SeekFrom::Start(start))?;
        let file = BufReader::with_capacity(READ_BUFFER_BYTES, file);
        let mut stream: Box<dyn Read + Send> = match self.packing {
            Packing::Plain => return Ok(Unpacked::Plain(file)),
            Packing::Text => return Ok(Unpacked::Text(Box::new(TextNumbers::new(file, self.element)))),
            Packing::Gzip => Box::new(Gzip::new(file)),
            Packing::Zlib => Box::new(ZlibDecoder::new(file)),
        };
        skip(&mut stream, self.start.unpacked_bytes)?;
        Ok(Unpacked::Packed(stream))
    }
}

/// An open file.
enum Unpacked {
    /// Any place can be gone to.
    Plain(BufReader<File>),
    /// Only later places can.
    Text(Box<dyn Read + Send>),
    /// Likewise, and what is at its end tells whether it was whole.
    Packed(Box<dyn Read + Send>),
}

/// The file that is open, and where it is read.
struct Opened {
    index: usize,
    position: u64,
    unpacked: Unpacked,
}

/// Reads from any place; cheap where the places ascend.
pub(super) struct DataStream {
    source: Source,
    opened: Option<Opened>,
}

/// What went wrong with which file.
pub(super) struct StreamError {
    pub path: PathBuf,
    pub cause: Error,
}

impl DataStream {
    pub fn new(source: Source) -> Self {
        Self { source, opened: None }
    }

    /// Fills `bytes` with those from `position` on, which may lie in several files.
    pub fn read_at(&mut self, position: u64, bytes: &mut [u8]) -> std::result::Result<(), StreamError> {
        let file_bytes = self.source.file_bytes;
        let mut done = 0;
        while done < bytes.len() {
            let position = position + done as u64;
            let (index, inside) = ((position / file_bytes) as usize, position % file_bytes);
            let most = usize::try_from(file_bytes - inside).unwrap_or(usize::MAX);
            let count = most.min(bytes.len() - done);
            let part = &mut bytes[done..done + count];
            if self.opened.as_ref().is_some_and(|opened| opened.index != index) {
                self.finish()?;
            }
            self.read_in(index, inside, part).map_err(|cause| {
                // What is known of a stream that failed is not to be relied on.
                self.opened = None;
                StreamError { path: self.source.files.path(index), cause }
            })?;
            done += count;
        }
        Ok(())
    }

    /// Leaves the file that is open, after reading what is left of a packed one: only its end tells whether all of it was
    /// whole.
    pub fn finish(&mut self) -> std::result::Result<(), StreamError> {
        let Some(opened) = self.opened.take() else { return Ok(()) };
        let path = self.source.files.path(opened.index);
        opened.finish(&path, self.source.file_bytes).map_err(|cause| StreamError { path, cause })
    }

    /// Fills `bytes` from one file.
    fn read_in(&mut self, index: usize, position: u64, bytes: &mut [u8]) -> Result<()> {
        let opened = match self.opened.take() {
            Some(opened) if opened.can_go_to(index, position) => opened,
            _ => {
                let unpacked = self.source.open(&self.source.files.path(index))?;
                Opened { index, position: 0, unpacked }
            }
        };
        self.opened.insert(opened).read(position, bytes)
    }
}

impl Opened {
    fn can_go_to(&self, index: usize, position: u64) -> bool {
        let is_ahead = position >= self.position || matches!(self.unpacked, Unpacked::Plain(_));
        self.index == index && is_ahead
    }

    fn read(&mut self, position: u64, bytes: &mut [u8]) -> Result<()> {
        match &mut self.unpacked {
            Unpacked::Plain(file) => {
                file.seek_relative(position as i64 - self.position as i64)?;
                file.read_exact(bytes)?;
            }
            Unpacked::Text(stream) | Unpacked::Packed(stream) => {
                skip(stream, position - self.position)?;
                stream.read_exact(bytes)?;
            }
        }
        self.position = position + bytes.len() as u64;
        Ok(())
    }

    /// Reads a packed file to its end, which must not come before `promised` bytes of voxels.
    fn finish(self, path: &Path, promised: u64) -> Result<()> {
        let Unpacked::Packed(mut stream) = self.unpacked else { return Ok(()) };
        let found = self.position + std::io::copy(&mut stream, &mut std::io::sink())?;
        if found < promised {
            return Err(Error::new(
                ErrorKind::UnexpectedEof,
                format!("{found} of its {promised} bytes are there"),
            ));
        }
        warn_of_more(path, found, promised);
        Ok(())
    }
}

/// Tells of bytes after the voxels, which may be a sign of a wrong header.
pub(super) fn warn_of_more(path: &Path, found: u64, promised: u64) {
    if found > promised {
        tracing::warn!(path = %path.display(), found, promised, "more bytes than the header says");
    }
}

fn skip(stream: &mut impl Read, bytes: u64) -> Result<()> {
    match std::io::copy(&mut stream.take(bytes), &mut std::io::sink())? {
        skipped if skipped == bytes => Ok(()),
        _ => Err(ErrorKind::UnexpectedEof.into()),
    }
}
