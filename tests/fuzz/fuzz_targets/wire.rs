//! Decodes hostile messages between front-end and back-end; what is taken is written and read again, the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use protocol::wire::{BODY_LIMIT_BYTES, WireMessage, decode, encode};
use protocol::{FromBackend, FromFrontend};

/// What decoding promises: the body's limit, a small multiple of the message, and messages written again.
const CONSTANT_BYTES: usize = 2 * BODY_LIMIT_BYTES;
/// Memory per byte of a message.
const BYTES_PER_BYTE: usize = 64;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let _budget = Budget::new(CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len());
    match first & 1 {
        0 => read::<FromFrontend>(bytes),
        _ => read::<FromBackend>(bytes),
    }
});

fn read<M: WireMessage>(bytes: &[u8]) {
    let Ok(message) = decode::<M>(bytes) else { return };
    let Ok(written) = encode(&message) else { return };
    // Bytes, not messages: what is no number is not equal to itself.
    let again = decode::<M>(&written).expect("what was written can be read");
    assert_eq!(encode(&again).expect("it was written before"), written);
}
