//! The records of a file or of a chunk, one after the other: no length reaches the library unchecked.

use crate::fields;
use mcap::records::Record;

/// A record begins with its kind, and its length in eight bytes.
const PREFIX_BYTES: usize = 9;

/// Goes through some bytes once.
pub struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Records<'a> {
    /// From a byte on.
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// The byte that the next record begins at.
    pub fn at(&self) -> usize {
        self.at
    }

    fn read(&mut self) -> Result<Record<'a>, String> {
        let at = self.at;
        let rest = self.bytes.get(at..).unwrap_or_default();
        // Nothing follows a spoiled record: its length leads nowhere.
        self.at = self.bytes.len();
        let ([opcode, length @ ..], rest) = rest
            .split_first_chunk::<PREFIX_BYTES>()
            .ok_or_else(|| format!("it ends at byte {}, within a record", self.bytes.len()))?;
        let length = u64::from_le_bytes(*length);
        let body = usize::try_from(length).ok().and_then(|length| rest.get(..length));
        let body = body.ok_or_else(|| {
            format!("the record at byte {at} claims {length} bytes, and {} are left", rest.len())
        })?;
        let spoiled = |what| format!("the record at byte {at}, of kind {opcode}, is spoiled: {what}");
        fields::check(*opcode, body).map_err(spoiled)?;
        let record = mcap::parse_record(*opcode, body).map_err(|error| spoiled(error.to_string()))?;
        self.at = at + PREFIX_BYTES + body.len();
        Ok(record)
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = Result<Record<'a>, String>;

    fn next(&mut self) -> Option<Self::Item> {
        (self.at < self.bytes.len()).then(|| self.read())
    }
}
