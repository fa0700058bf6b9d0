//! The records of a file, also those within its chunks.

use mcap::read::{ChunkReader, LinearReader, Options};
use mcap::records::{ChunkHeader, Record};
use mcap::{McapError, McapResult};
use std::collections::VecDeque;

/// A chunk that says that it holds more is spoiled: it would be given that much memory. Those of tapes hold a second.
const LARGEST_CHUNK_BYTES: u64 = 256 << 20;

/// Goes through a file once.
pub struct Flattened<'a> {
    file: LinearReader<'a>,
    /// What is left of a chunk.
    chunk: VecDeque<McapResult<Record<'static>>>,
}

impl<'a> Flattened<'a> {
    /// From its beginning; it need have no end.
    ///
    /// # Errors
    /// It does not begin as these files do.
    pub fn new(bytes: &'a [u8]) -> McapResult<Self> {
        let file = LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into())?;
        Ok(Self { file, chunk: VecDeque::new() })
    }
}

/// All records of a chunk, if it is what its header says.
fn unpacked(header: ChunkHeader, data: &[u8]) -> McapResult<VecDeque<McapResult<Record<'static>>>> {
    if header.uncompressed_size > LARGEST_CHUNK_BYTES {
        return Err(McapError::UnexpectedEof);
    }
    // Checked as a whole before any length in it is believed: the library's own reader reserves what a record says.
    let plain = match header.compression.as_str() {
        "zstd" => zstd::bulk::decompress(data, header.uncompressed_size as usize)?,
        "" => data.to_vec(),
        other => return Err(McapError::UnsupportedCompression(other.to_owned())),
    };
    let calculated = crc32fast::hash(&plain);
    if header.uncompressed_crc != calculated {
        return Err(McapError::BadChunkCrc { saved: header.uncompressed_crc, calculated });
    }
    let (size, compression) = (plain.len() as u64, String::new());
    let header = ChunkHeader { compression, compressed_size: size, uncompressed_size: size, ..header };
    let mut records = VecDeque::new();
    for record in ChunkReader::new(header, &plain)? {
        records.push_back(Ok(record?.into_owned()));
    }
    Ok(records)
}

impl<'a> Iterator for Flattened<'a> {
    type Item = McapResult<Record<'a>>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(record) = self.chunk.pop_front() {
                return Some(record);
            }
            match self.file.next()? {
                Ok(Record::Chunk { header, data }) => match unpacked(header, &data) {
                    Ok(records) => self.chunk = records,
                    Err(error) => return Some(Err(error)),
                },
                other => return Some(other),
            }
        }
    }
}
