//! A datagram of OpenTrackIO: 16 bytes before a sample, or before a part of one.

use crate::Refusal;
use crate::bytes::Bytes;

const MAGIC: [u8; 4] = *b"OTrk";
/// Where the checksum stands, after all of the header that it covers.
const CHECKSUM_AT: usize = 14;
/// The bit that marks a last part; the others are the payload's length.
const LAST: u16 = 1 << 15;

/// How a sample is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As JSON.
    Json,
    /// As CBOR.
    Cbor,
}

/// A datagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    /// How its sample is written.
    pub encoding: Encoding,
    /// Grows by one with each datagram, and wraps.
    pub sequence: u16,
    /// Where in the sample its payload belongs, bytes.
    pub offset: u32,
    /// Whether the sample ends with it.
    pub is_last: bool,
    /// A sample, or a part of one.
    pub payload: &'a [u8],
}

/// The packet of a datagram.
///
/// # Errors
/// Another protocol, length, checksum or encoding.
pub fn parse(datagram: &[u8]) -> Result<Packet<'_>, Refusal> {
    let mut bytes = Bytes(datagram);
    if bytes.array()? != MAGIC {
        return Err(Refusal::Foreign);
    }
    let [_reserved, encoding] = bytes.array()?;
    let (sequence, offset, length) = (bytes.u16()?, bytes.u32()?, bytes.u16()?);
    let (checksum, payload) = (bytes.u16()?, bytes.0);
    match payload.len().cmp(&usize::from(length & !LAST)) {
        std::cmp::Ordering::Less => return Err(Refusal::Short),
        std::cmp::Ordering::Greater => return Err(Refusal::Long),
        std::cmp::Ordering::Equal => {}
    }
    if fletcher16(datagram[..CHECKSUM_AT].iter().chain(payload)) != checksum {
        return Err(Refusal::Checksum);
    }
    let encoding = match encoding {
        1 => Encoding::Json,
        2 => Encoding::Cbor,
        _ => return Err(Refusal::Foreign),
    };
    Ok(Packet { encoding, sequence, offset, is_last: length & LAST != 0, payload })
}

/// Fletcher's checksum with both sums modulo 256, as OpenTrackIO has it; others take them modulo 255.
fn fletcher16<'b>(bytes: impl Iterator<Item = &'b u8>) -> u16 {
    let (mut first, mut second) = (0_u8, 0_u8);
    for &byte in bytes {
        first = first.wrapping_add(byte);
        second = second.wrapping_add(first);
    }
    u16::from_be_bytes([second, first])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A datagram as the protocol's page lays it out.
    pub(crate) fn datagram(
        encoding: u8,
        sequence: u16,
        offset: u32,
        is_last: bool,
        payload: &[u8],
    ) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &[0, encoding], &sequence.to_be_bytes(), &offset.to_be_bytes()].concat();
        let length = payload.len() as u16 | if is_last { LAST } else { 0 };
        bytes.extend(length.to_be_bytes());
        let checksum = fletcher16(bytes.iter().chain(payload));
        bytes.extend(checksum.to_be_bytes());
        bytes.extend(payload);
        bytes
    }

    #[test]
    fn sums_are_modulo_256() {
        // By hand: 1, 3, 6 and 1, 4, 10; and past 255, where modulo 255 differs.
        assert_eq!(fletcher16([1, 2, 3].iter()), 10 << 8 | 6);
        assert_eq!(fletcher16([255, 1].iter()), 255 << 8);
    }

    #[test]
    fn a_packet_comes_back_and_a_spoiled_one_is_refused() {
        let good = datagram(2, 65_535, 70_000, false, b"abc");
        let expected = Packet {
            encoding: Encoding::Cbor,
            sequence: 65_535,
            offset: 70_000,
            is_last: false,
            payload: b"abc",
        };
        assert_eq!(parse(&good), Ok(expected));
        for length in 0..good.len() {
            assert_eq!(parse(&good[..length]), Err(Refusal::Short), "{length}");
        }
        assert_eq!(parse(&[&good[..], b"d"].concat()), Err(Refusal::Long));
        for bit in 0..8 * good.len() {
            let mut spoiled = good.clone();
            spoiled[bit / 8] ^= 1 << (bit % 8);
            assert!(parse(&spoiled).is_err(), "bit {bit}");
        }
        assert_eq!(parse(&datagram(3, 0, 0, true, b"")), Err(Refusal::Foreign));
    }
}
