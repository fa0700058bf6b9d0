//! Hostile bytes: no parser panics on them, or takes more memory than their length allows.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

use inputs::opentrackio::packet::{self, Encoding};
use inputs::opentrackio::sample;
use inputs::vrpn::{Session, wire};
use inputs::{dtrack, freed, gamepad, osc, spacemouse};
use std::alloc::{GlobalAlloc, Layout, System};
use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, which keeps the most that was held at a time.
struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;
static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: it is the system's allocator, and only counts beside.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(LIVE.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        // SAFETY: the caller's promises are those that the system's allocator asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the same.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Memory beside what grows with a message: buffers of the readers of JSON and CBOR, and of the test's own harness.
const CONSTANT_BYTES: usize = 1 << 16;
/// Memory per byte of a message: OSC keeps 32 bytes for an argument that takes one, in a list that doubles.
const BYTES_PER_BYTE: usize = 96;
const ROUNDS: u32 = 20_000;
const SEED: u64 = 72;

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }

    /// A message with some bytes changed, cut out, doubled, or set to what numbers end at.
    fn mutated(&mut self, seed: &[u8]) -> Vec<u8> {
        let mut bytes = seed.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            let end = (at + self.below(24)).min(bytes.len());
            match self.below(5) {
                0 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                1 => bytes[at..end].fill([0, 0x7f, 0x80, 0xff, b'9', b'['][self.below(6)]),
                2 => drop(bytes.drain(at..end)),
                3 => {
                    let part = bytes[at..end].to_vec();
                    (0..=self.below(40)).for_each(|_| drop(bytes.splice(at..at, part.iter().copied())));
                }
                _ => bytes.truncate(end),
            }
        }
        bytes
    }
}

/// The name of a parser, what its messages are mutations of, and the parser itself.
type Seed = (&'static str, Vec<u8>, fn(&[u8]));

/// What each parser is given to begin with; text formats as text.
fn seeds() -> Vec<Seed> {
    let dtrack = "fr 1\nts 5.0\n6d 2 [0 1.000][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1] [1 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1]\n\
                  6df2 1 1 [0 1.000 6 2][1 2 3][1 0 0 0 1 0 0 0 1][2 0.5 -1]\n\
                  6dmt2 1 1 [0 1.0 4 2.0][1 2 3][1 0 0 0 1 0 0 0 1][5][1 2 3 4 5 6]\n";
    let json = r#"{"transforms":[{"translation":{"x":1,"y":2,"z":3},"rotation":{"pan":9,"tilt":0,"roll":0},"id":"a"}],
                   "timing":{"sampleTimestamp":{"seconds":1,"nanoseconds":5}},"lens":{"distortion":[{"radial":[1,2,3]}]}}"#;
    let value: serde_json::Value = serde_json::from_str(json).unwrap();
    let mut cbor = Vec::new();
    ciborium::into_writer(&value, &mut cbor).unwrap();
    let packet = [b"OTrk\0\x01\0\x05\0\0\0\0\x80\x07\0\0".to_vec(), b"{\"a\":1}".to_vec()].concat();
    let osc = b"#bundle\0\0\0\0\0\0\0\0\x01\0\0\0\x3c/lightloom/pose/1\0\0\0,fffffff\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0";
    vec![
        ("dtrack", dtrack.into(), |bytes| _ = black_box(dtrack::parse(bytes))),
        ("json", json.into(), |bytes| _ = black_box(sample::parse(Encoding::Json, bytes))),
        ("cbor", cbor, |bytes| _ = black_box(sample::parse(Encoding::Cbor, bytes))),
        ("opentrackio", packet, |bytes| _ = black_box(packet::parse(bytes))),
        ("osc", osc.to_vec(), |bytes| _ = black_box(osc::parse(bytes))),
        ("freed", vec![0xd1; 29], |bytes| _ = black_box(freed::parse(bytes))),
        ("gamepad", vec![1; 8], |bytes| _ = black_box(gamepad::parse(bytes))),
        ("spacemouse", [1, 0, 0, 0].repeat(8), |bytes| _ = black_box(spacemouse::parse(bytes))),
        ("vrpn", vrpn(), hear),
    ]
}

/// A device, types, and a message of each.
fn vrpn() -> Vec<u8> {
    let time = std::time::Duration::from_secs(1);
    let message =
        |sender, kind, payload: &[u8]| wire::write(&wire::Message { time, sender, kind, payload }, 0);
    let named = |name: &str| [&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat();
    let types = ["vrpn_Tracker Pos_Quat", "vrpn_Button States", "vrpn_Analog Channel"];
    let types = types.iter().zip(1..).map(|(name, number)| message(number, wire::TYPE, &named(name)));
    let said = [&[0; 64][..], &[0, 0, 0, 1, 0, 0, 0, 1], &[0; 8]];
    let said = said.iter().zip(1..).map(|(payload, kind)| message(1, kind, payload));
    [message(1, wire::SENDER, &named("Wand"))].into_iter().chain(types).chain(said).flatten().collect()
}

fn hear(mut bytes: &[u8]) {
    let mut session = Session::new("Wand");
    while let Ok(Some((message, length))) = wire::parse(bytes) {
        drop(black_box(session.heard(&message)));
        bytes = &bytes[length..];
    }
}

/// The most that was held while something was done, beyond what was held before.
fn held(deed: impl FnOnce()) -> usize {
    let before = LIVE.load(Relaxed);
    PEAK.store(before, Relaxed);
    deed();
    PEAK.load(Relaxed).saturating_sub(before)
}

#[test]
fn no_parser_panics_or_takes_more_than_its_share() {
    println!("seed {SEED}");
    let mut random = Random(SEED);
    assert!(held(|| drop(black_box(vec![0_u8; 1 << 20]))) >= 1 << 20, "the canary: memory is counted");
    for (name, seed, parse) in seeds() {
        let mut most = 0;
        for round in 0..ROUNDS {
            let bytes = random.mutated(&seed);
            let taken = held(|| parse(&bytes));
            let limit = CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len();
            assert!(taken <= limit, "{name}, round {round}: {taken} bytes for {}", bytes.len());
            most = most.max(taken);
        }
        println!("{name}: {most} bytes at most for {} and their mutations", seed.len());
    }
}
