//! Messages over a stream of bytes: of each its length, four bytes little-endian, and then the message.

use crossbeam_channel::{Receiver, bounded};
use protocol::wire::MESSAGE_LIMIT_BYTES;
use std::io::{self, ErrorKind, Read};
use std::thread::Builder;

const LENGTH_BYTES: usize = size_of::<u32>();

/// How many messages are taken off the stream before anybody wants them. Few, because each may be a picture.
const MOST_AHEAD: usize = 4;

/// What goes before a message.
pub fn length_of(message: &[u8]) -> [u8; LENGTH_BYTES] {
    // No message is over the limit, which is far below what the length can say.
    (message.len() as u32).to_le_bytes()
}

/// The messages that come over a stream, until it ends or cannot be understood. A thread of their own takes them off: who
/// waits for them may wait for other things too.
///
/// # Errors
/// The system has no thread left.
pub fn incoming(mut stream: impl Read + Send + 'static) -> io::Result<Receiver<Vec<u8>>> {
    let (outbox, inbox) = bounded(MOST_AHEAD);
    let take_off = move || {
        while let Ok(message) = take(&mut stream) {
            if outbox.send(message).is_err() {
                return;
            }
        }
    };
    Builder::new().name("incoming".to_owned()).spawn(take_off)?;
    Ok(inbox)
}

/// The next message.
fn take(stream: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut length = [0; LENGTH_BYTES];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > MESSAGE_LIMIT_BYTES {
        return Err(ErrorKind::InvalidData.into());
    }
    let mut message = vec![0; length];
    stream.read_exact(&mut message)?;
    Ok(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_come_as_they_went_until_the_stream_ends() {
        let messages: [&[u8]; 3] = [b"one", b"", &[7; 100_000]];
        let mut bytes: Vec<u8> =
            messages.iter().flat_map(|message| [&length_of(message), *message].concat()).collect();
        bytes.extend([9, 0, 0, 0, 1]);
        let inbox = incoming(io::Cursor::new(bytes)).unwrap();
        assert!(inbox.iter().eq(messages), "and nothing of the one that is cut short");
    }

    #[test]
    fn a_length_over_the_limit_ends_the_stream() {
        let inbox = incoming(io::repeat(0xff)).unwrap();
        assert_eq!(inbox.iter().count(), 0);
    }
}
