//! The parser of every protocol, and a message to begin with. Fuzzing shares this file.

use inputs::opentrackio::packet::{self, Encoding};
use inputs::opentrackio::sample;
use inputs::vrpn::{Session, wire};
use inputs::{dtrack, freed, gamepad, osc, spacemouse};
use std::hint::black_box;
use std::time::Duration;

/// A protocol.
pub struct Protocol {
    /// Its name.
    pub name: &'static str,
    /// A message, that others are mutations of.
    pub seed: fn() -> Vec<u8>,
    /// Its parser.
    pub parse: fn(&[u8]),
}

/// All of them.
pub const PROTOCOLS: [Protocol; 9] = [
    Protocol { name: "dtrack", seed: || DTRACK.into(), parse: |bytes| _ = black_box(dtrack::parse(bytes)) },
    Protocol {
        name: "json",
        seed: || JSON.into(),
        parse: |bytes| _ = black_box(sample::parse(Encoding::Json, bytes)),
    },
    Protocol { name: "cbor", seed: cbor, parse: |bytes| _ = black_box(sample::parse(Encoding::Cbor, bytes)) },
    Protocol {
        name: "opentrackio",
        seed: || SEGMENT.into(),
        parse: |bytes| _ = black_box(packet::parse(bytes)),
    },
    Protocol { name: "osc", seed: || OSC.into(), parse: |bytes| _ = black_box(osc::parse(bytes)) },
    Protocol { name: "freed", seed: || vec![0xd1; 29], parse: |bytes| _ = black_box(freed::parse(bytes)) },
    Protocol { name: "gamepad", seed: || vec![1; 8], parse: |bytes| _ = black_box(gamepad::parse(bytes)) },
    Protocol {
        name: "spacemouse",
        seed: || [1, 0, 0, 0].repeat(8),
        parse: |bytes| _ = black_box(spacemouse::parse(bytes)),
    },
    Protocol { name: "vrpn", seed: vrpn, parse: hear },
];

const DTRACK: &str = "fr 1\nts 5.0\n6d 2 [0 1.000][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1] [1 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]\n\
                  6df2 1 1 [0 1.000 6 2][1 2 3][1 0 0 0 1 0 0 0 1][2 0.5 -1]\n\
                  6dmt2 1 1 [0 1.0 4 2.0][1 2 3][1 0 0 0 1 0 0 0 1][5][1 2 3 4 5 6]\n";
const JSON: &str = r#"{"transforms":[{"translation":{"x":1,"y":2,"z":3},"rotation":{"pan":9,"tilt":0,"roll":0},"id":"a"}],
                   "timing":{"sampleTimestamp":{"seconds":1,"nanoseconds":5}},"lens":{"distortion":[{"radial":[1,2,3]}]}}"#;
const SEGMENT: &[u8] = b"OTrk\0\x01\0\x05\0\0\0\0\x80\x07\0\0{\"a\":1}";
const OSC: &[u8] = b"#bundle\0\0\0\0\0\0\0\0\x01\0\0\0\x3c/lightloom/pose/1\0\0\0,fffffff\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0";

/// The same as in JSON.
fn cbor() -> Vec<u8> {
    let value: serde_json::Value = serde_json::from_str(JSON).expect("it is JSON");
    let mut bytes = Vec::new();
    ciborium::into_writer(&value, &mut bytes).expect("memory can be written");
    bytes
}

/// A device, types, and a message of each.
fn vrpn() -> Vec<u8> {
    let time = Duration::from_secs(1);
    let message =
        |sender, kind, payload: &[u8]| wire::write(&wire::Message { time, sender, kind, payload }, 0);
    let named = |name: &str| [&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat();
    let types = ["vrpn_Tracker Pos_Quat", "vrpn_Button States", "vrpn_Analog Channel"];
    let types = types.iter().zip(1..).map(|(name, number)| message(number, wire::TYPE, &named(name)));
    let said = [&[0; 64][..], &[0, 0, 0, 1, 0, 0, 0, 1], &[0; 8]];
    let said = said.iter().zip(1..).map(|(payload, kind)| message(1, kind, payload));
    [message(1, wire::SENDER, &named("Wand"))].into_iter().chain(types).chain(said).flatten().collect()
}

/// A session that hears one message after the other.
fn hear(mut bytes: &[u8]) {
    let mut session = Session::new("Wand");
    while let Ok(Some((message, length))) = wire::parse(bytes) {
        drop(black_box(session.heard(&message)));
        bytes = &bytes[length..];
    }
}
