//! The bytes of VRPN: its cookie and its messages, big-endian.

use crate::Refusal;
use crate::bytes::Bytes;
use std::time::Duration;

/// What both ends send first: the version, and whether they want a log (no).
pub const COOKIE: [u8; 24] = *b"vrpn: ver. 07.38  0\0\0\0\0\0";
/// How much of a cookie has to be the same: all up to the minor version.
const SAME: usize = "vrpn: ver. 07.".len();
/// Bytes before a payload.
const HEADER: usize = 24;
/// Payloads are filled up to a multiple of so many bytes.
const ALIGNMENT: usize = 8;
/// A server's own buffers are as long.
pub const LONGEST: usize = 64_000;

/// Types of messages that have a fixed number.
pub const SENDER: i32 = -1;
/// The description of a type: its number stands where others have their sender.
pub const TYPE: i32 = -2;
/// The port to which datagrams may be sent.
pub const UDP: i32 = -3;
/// The other end leaves.
pub const GOODBYE: i32 = -5;

/// A message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// When it was made, since the Unix epoch.
    pub time: Duration,
    /// The number of a device.
    pub sender: i32,
    /// The number of a type.
    pub kind: i32,
    /// All else.
    pub payload: &'a [u8],
}

/// Checks what the other end sent first.
///
/// # Errors
/// It is no VRPN server, or one of another version.
pub fn check_cookie(cookie: &[u8; 24]) -> Result<(), Refusal> {
    if cookie[..SAME] == COOKIE[..SAME] { Ok(()) } else { Err(Refusal::Foreign) }
}

/// The first message of some bytes, and how many bytes it took; nothing if it has not arrived whole.
///
/// # Errors
/// A length or a time that no message has: from here on nothing can be read.
pub fn parse(bytes: &[u8]) -> Result<Option<(Message<'_>, usize)>, Refusal> {
    let mut header = Bytes(bytes);
    let Ok(length) = header.u32() else { return Ok(None) };
    let length = length as usize;
    if !(HEADER..=LONGEST).contains(&length) {
        return Err(if length > LONGEST { Refusal::Long } else { Refusal::Form });
    }
    let taken = length.next_multiple_of(ALIGNMENT);
    if bytes.len() < taken {
        return Ok(None);
    }
    let (seconds, microseconds) = (header.u32()?, header.u32()?);
    let (sender, kind) = (header.i32()?, header.i32()?);
    if microseconds >= 1_000_000 {
        return Err(Refusal::Form);
    }
    let time = Duration::new(seconds.into(), microseconds * 1000);
    Ok(Some((Message { time, sender, kind, payload: &bytes[HEADER..length] }, taken)))
}

/// A message as bytes. `sequence` grows with each.
pub fn write(message: &Message<'_>, sequence: u32) -> Vec<u8> {
    let length = HEADER + message.payload.len();
    let mut bytes = Vec::with_capacity(length.next_multiple_of(ALIGNMENT));
    bytes.extend((length as u32).to_be_bytes());
    bytes.extend((message.time.as_secs() as u32).to_be_bytes());
    bytes.extend(message.time.subsec_micros().to_be_bytes());
    bytes.extend(message.sender.to_be_bytes());
    bytes.extend(message.kind.to_be_bytes());
    bytes.extend(sequence.to_be_bytes());
    bytes.extend(message.payload);
    bytes.resize(length.next_multiple_of(ALIGNMENT), 0);
    bytes
}

/// The name in the payload of a description.
///
/// # Errors
/// It does not have the length that it says, or is no text.
pub fn name(payload: &[u8]) -> Result<&str, Refusal> {
    let mut bytes = Bytes(payload);
    let length = bytes.u32()? as usize;
    let name = bytes.take(length)?;
    let name = name.split(|&byte| byte == 0).next().unwrap_or_default();
    std::str::from_utf8(name).map_err(|_| Refusal::Form)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_message_comes_back_whole_or_not_at_all() {
        let time = Duration::new(1_700_000_000, 123_456_000);
        for payload in [&b""[..], b"1234567", b"12345678"] {
            let message = Message { time, sender: 3, kind: -2, payload };
            let bytes = write(&message, 9);
            assert_eq!(bytes.len() % 8, 0);
            assert_eq!(bytes[..4], (24 + payload.len() as u32).to_be_bytes());
            assert_eq!(parse(&bytes), Ok(Some((message, bytes.len()))));
            assert_eq!(parse(&[&bytes[..], &bytes].concat()), Ok(Some((message, bytes.len()))));
            for length in 0..bytes.len() {
                assert_eq!(parse(&bytes[..length]), Ok(None), "{length}");
            }
        }
    }

    #[test]
    fn lengths_and_times_that_cannot_be_are_refused() {
        let length = |length: u32| parse(&[&length.to_be_bytes()[..], &[0; 40]].concat()).map(|_| ());
        assert_eq!(length(23), Err(Refusal::Form));
        assert_eq!(length(24), Ok(()));
        assert_eq!(length(LONGEST as u32 + 1), Err(Refusal::Long));
        assert_eq!(length(u32::MAX), Err(Refusal::Long));
        let late = [&24_u32.to_be_bytes()[..], &[0xff; 8], &[0; 12]].concat();
        assert_eq!(parse(&late), Err(Refusal::Form));
    }

    #[test]
    fn the_cookie_s_minor_version_is_free() {
        let mut cookie = COOKIE;
        cookie[14..16].copy_from_slice(b"35");
        assert_eq!(check_cookie(&cookie), Ok(()));
        cookie[12] = b'6';
        assert_eq!(check_cookie(&cookie), Err(Refusal::Foreign));
        assert_eq!(check_cookie(&[0; 24]), Err(Refusal::Foreign));
    }

    #[test]
    fn names_end_at_their_zero() {
        assert_eq!(name(b"\0\0\0\x09Tracker0\0rest"), Ok("Tracker0"));
        assert_eq!(name(b"\0\0\0\x02A"), Err(Refusal::Short));
        assert_eq!(name(b"\xff\xff\xff\xffA"), Err(Refusal::Short));
        assert_eq!(name(b"\0\0\0\x02\xff\0"), Err(Refusal::Form));
    }
}
