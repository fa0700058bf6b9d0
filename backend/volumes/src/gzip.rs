//! A gzip file, unpacked: its members one after the other, each with its checksum.

use flate2::bufread::GzDecoder;
use std::io::{BufRead, Read, Result};

/// The first byte of a member (RFC 1952).
const FIRST_BYTE: u8 = 0x1f;

/// What the members unpack to. Reading to the end checks them all; what follows them and is no member is passed over, as
/// gzip does.
pub(super) struct Gzip<R> {
    /// None after the last member.
    member: Option<GzDecoder<R>>,
}

impl<R: BufRead> Gzip<R> {
    pub fn new(packed: R) -> Self {
        Self { member: Some(GzDecoder::new(packed)) }
    }
}

impl<R: BufRead> Read for Gzip<R> {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize> {
        while let Some(member) = &mut self.member {
            let read = member.read(bytes)?;
            if read > 0 || bytes.is_empty() {
                return Ok(read);
            }
            let is_followed = member.get_mut().fill_buf()?.first() == Some(&FIRST_BYTE);
            let ended = self.member.take().filter(|_| is_followed);
            self.member = ended.map(|member| GzDecoder::new(member.into_inner()));
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::{BufReader, ErrorKind, Write};

    fn packed(text: &str) -> Vec<u8> {
        let mut packed = GzEncoder::new(Vec::new(), Compression::default());
        packed.write_all(text.as_bytes()).unwrap();
        packed.finish().unwrap()
    }

    /// However few bytes are in the buffer.
    fn unpacked(packed: &[u8]) -> Result<String> {
        let read = |buffer| {
            let mut text = String::new();
            Gzip::new(BufReader::with_capacity(buffer, packed)).read_to_string(&mut text).map(|_| text)
        };
        for buffer in [1, 7] {
            assert_eq!(read(buffer).ok(), read(4096).ok());
        }
        read(4096)
    }

    #[test]
    fn members_follow_each_other() {
        let two = [packed("one, "), packed("two")].concat();
        assert_eq!(unpacked(&two).unwrap(), "one, two");
        assert_eq!(unpacked(&[&two[..], &[0; 512]].concat()).unwrap(), "one, two");
    }

    #[test]
    fn every_member_s_end_is_looked_at() {
        let two = [packed("one, "), packed("two")].concat();
        for length in packed("one, ").len() + 1..two.len() {
            assert_eq!(unpacked(&two[..length]).unwrap_err().kind(), ErrorKind::UnexpectedEof, "{length}");
        }
        for end in [packed("one, ").len(), two.len()] {
            for at in end - 8..end {
                let mut wrong = two.clone();
                wrong[at] ^= 1;
                assert!(unpacked(&wrong).is_err(), "{at}");
            }
        }
    }
}
