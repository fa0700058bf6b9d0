//! Gives hostile messages of trackers and controllers to the parser of every protocol.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use lightloom_fuzz::protocols::PROTOCOLS;

/// Memory beside what grows with a message: buffers of the readers of JSON and CBOR, sentences of refusals.
const CONSTANT_BYTES: usize = 1 << 18;
/// Memory per byte of a message: OSC keeps 32 bytes for an argument that takes one, in a list that doubles.
const BYTES_PER_BYTE: usize = 128;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let _budget = Budget::new(CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len());
    (PROTOCOLS[usize::from(first) % PROTOCOLS.len()].parse)(bytes);
});
