//! The records of a file, also those within its chunks.

use crate::records::Records;
use mcap::records::{ChunkHeader, Record};

/// A chunk that claims to hold more is spoiled: it would be given that much memory. Writers end a chunk after 768 KiB and a
/// message.
const LARGEST_CHUNK_BYTES: u64 = 16 << 20;

/// Goes through a file once.
pub struct Flattened<'a> {
    file: Records<'a>,
    /// The chunk that it is in, unpacked.
    chunk: Vec<u8>,
    /// The byte of the chunk that the next record begins at.
    chunk_at: usize,
    is_over: bool,
}

impl<'a> Flattened<'a> {
    /// From its beginning; it need have no end.
    ///
    /// # Errors
    /// It does not begin as these files do.
    pub fn new(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(mcap::MAGIC) {
            return Err("it does not begin as MCAP files do".to_owned());
        }
        let file = Records::new(bytes, mcap::MAGIC.len());
        Ok(Self { file, chunk: Vec::new(), chunk_at: 0, is_over: false })
    }
}

/// What a chunk holds, if it is what its header says.
fn unpacked(header: &ChunkHeader, data: &[u8]) -> Result<Vec<u8>, String> {
    let claimed = header.uncompressed_size;
    if claimed > LARGEST_CHUNK_BYTES {
        return Err(format!("a chunk claims {claimed} bytes, and may have {LARGEST_CHUNK_BYTES}"));
    }
    let plain = match header.compression.as_str() {
        "zstd" => zstd::bulk::decompress(data, claimed as usize)
            .map_err(|error| format!("a chunk cannot be unpacked: {error}"))?,
        "" => data.to_vec(),
        other => return Err(format!("a chunk is packed by {other:?}, and tapes are by zstd")),
    };
    if plain.len() as u64 != claimed {
        return Err(format!("a chunk claims {claimed} bytes, and holds {}", plain.len()));
    }
    if crc32fast::hash(&plain) != header.uncompressed_crc {
        return Err("the checksum of a chunk differs".to_owned());
    }
    Ok(plain)
}

impl<'a> Iterator for Flattened<'a> {
    type Item = Result<Record<'a>, String>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let mut chunk = Records::new(&self.chunk, self.chunk_at);
            if let Some(record) = chunk.next() {
                self.chunk_at = chunk.at();
                return Some(record.map(Record::into_owned));
            }
            if self.is_over {
                return None;
            }
            match self.file.next()? {
                Ok(Record::Chunk { header, data }) => match unpacked(&header, &data) {
                    Ok(plain) => (self.chunk, self.chunk_at) = (plain, 0),
                    Err(what) => return Some(Err(what)),
                },
                // The signature of the format follows, and no record.
                Ok(Record::Footer(footer)) => {
                    self.is_over = true;
                    return Some(Ok(Record::Footer(footer)));
                }
                other => return Some(other),
            }
        }
    }
}
