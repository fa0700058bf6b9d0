//! Hostile bytes: no parser panics on them, or takes more memory than their length allows.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod held;
mod protocols;

use held::held;
use inputs::opentrackio::packet::Encoding;
use inputs::opentrackio::sample;
use protocols::{PROTOCOLS, Protocol};
use std::hint::black_box;
use std::sync::Mutex;

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

/// Memory is counted for the whole process: one test at a time.
static TURN: Mutex<()> = Mutex::new(());

/// A list in CBOR that claims to hold 2⁶⁴ − 1 transforms, and ends there.
#[test]
fn a_list_gets_no_memory_for_what_it_claims() {
    let _turn = TURN.lock();
    let list = |header: &[u8], items: &[u8]| [b"\xa1\x6atransforms", header, items].concat();
    let parse = |bytes: &[u8]| sample::parse(Encoding::Cbor, bytes);
    assert!(parse(&list(b"\x80", &[])).unwrap().is_empty(), "the canary: an honest list is read");
    let bytes = list(&[0x9b, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff], &[]);
    let taken = held(|| assert!(black_box(parse(&bytes)).is_err()));
    let limit = BYTES_PER_BYTE * bytes.len();
    assert!(taken <= limit, "{taken} bytes for {}", bytes.len());
}

#[test]
fn no_parser_panics_or_takes_more_than_its_share() {
    let _turn = TURN.lock();
    println!("seed {SEED}");
    let mut random = Random(SEED);
    assert!(held(|| drop(black_box(vec![0_u8; 1 << 20]))) >= 1 << 20, "the canary: memory is counted");
    for Protocol { name, seed, parse } in PROTOCOLS {
        let seed = seed();
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
