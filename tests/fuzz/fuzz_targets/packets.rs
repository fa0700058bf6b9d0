//! Gives hostile messages of trackers and controllers to the parser of every protocol.
#![no_main]

use inputs::opentrackio::packet::{self, Encoding};
use inputs::opentrackio::sample;
use inputs::vrpn::{Session, wire};
use inputs::{dtrack, freed, gamepad, osc, spacemouse};
use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use lightloom_fuzz::protocols::Protocol;
use std::hint::black_box;

/// Memory beside what grows with a message: buffers of the readers of JSON and CBOR, sentences of refusals.
const CONSTANT_BYTES: usize = 1 << 18;
/// Memory per byte of a message: OSC keeps 32 bytes for an argument that takes one, in a list that doubles.
const BYTES_PER_BYTE: usize = 128;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let _budget = Budget::new(CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len());
    match Protocol::of_byte(first) {
        Protocol::Dtrack => drop(black_box(dtrack::parse(bytes))),
        Protocol::OpenTrackIo => drop(black_box(packet::parse(bytes))),
        Protocol::Json => drop(black_box(sample::parse(Encoding::Json, bytes))),
        Protocol::Cbor => drop(black_box(sample::parse(Encoding::Cbor, bytes))),
        Protocol::Osc => drop(black_box(osc::parse(bytes))),
        Protocol::FreeD => drop(black_box(freed::parse(bytes))),
        Protocol::Gamepad => drop(black_box(gamepad::parse(bytes))),
        Protocol::SpaceMouse => drop(black_box(spacemouse::parse(bytes))),
        Protocol::Vrpn => hear(bytes),
    }
});

/// A session of VRPN that hears one message after the other.
fn hear(mut bytes: &[u8]) {
    let mut session = Session::new("Wand");
    while let Ok(Some((message, length))) = wire::parse(bytes) {
        drop(black_box(session.heard(&message)));
        bytes = &bytes[length..];
    }
}
