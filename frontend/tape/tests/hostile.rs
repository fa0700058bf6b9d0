//! Tapes that lie: a length that a record claims costs no more memory than the file's own length allows, and is refused.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

#[path = "../../inputs/tests/held/mod.rs"]
mod held;

use held::held;
use mcap::records::op;
use std::hint::black_box;
use std::path::Path;
use std::sync::Mutex;
use tape::{Tape, TapeError, info};

/// Memory beside what grows with a tape: paths, sentences, and buffers of readers.
const CONSTANT_BYTES: usize = 1 << 16;
/// Memory per byte of a tape: an entry of a map takes eight bytes in it, and strings and a node of a tree here.
const BYTES_PER_BYTE: usize = 64;
/// What a chunk may claim, and then be given; the reader has the same number.
const LARGEST_CHUNK_BYTES: u64 = 16 << 20;
/// The largest lengths that four and eight bytes claim, and some that are as impossible here.
const LIES_OF_4: [u32; 3] = [1 << 20, i32::MAX as u32, u32::MAX];
const LIES_OF_8: [u64; 5] = [1 << 20, 1 << 32, 1 << 62, i64::MAX as u64, u64::MAX];

/// Memory is counted for the whole process: one test at a time.
static TURN: Mutex<()> = Mutex::new(());

/// A body that is put together field by field, and where lengths stand in it.
#[derive(Clone, Default)]
struct Body {
    bytes: Vec<u8>,
    lengths_of_4: Vec<usize>,
    lengths_of_8: Vec<usize>,
}

impl Body {
    fn numbers(mut self, bytes: usize) -> Self {
        self.bytes.resize(self.bytes.len() + bytes, 0);
        self
    }

    fn data_of_4(mut self, data: &[u8]) -> Self {
        self.lengths_of_4.push(self.bytes.len());
        self.bytes.extend((data.len() as u32).to_le_bytes());
        self.bytes.extend(data);
        self
    }

    fn data_of_8(mut self, data: &[u8]) -> Self {
        self.lengths_of_8.push(self.bytes.len());
        self.bytes.extend((data.len() as u64).to_le_bytes());
        self.bytes.extend(data);
        self
    }

    fn map(mut self, pairs: &[(&str, &str)]) -> Self {
        let inner = pairs.iter().fold(Self::default(), |body, pair| body.text(pair.0).text(pair.1));
        let at = self.bytes.len() + 4;
        self = self.data_of_4(&inner.bytes);
        self.lengths_of_4.extend(inner.lengths_of_4.iter().map(|inner| at + inner));
        self
    }

    fn text(self, text: &str) -> Self {
        self.data_of_4(text.as_bytes())
    }

    /// The same with each of its lengths a lie.
    fn lies(&self) -> Vec<Vec<u8>> {
        let lie = |at: usize, lie: &[u8]| {
            let mut bytes = self.bytes.clone();
            bytes[at..at + lie.len()].copy_from_slice(lie);
            bytes
        };
        let of_4 = self.lengths_of_4.iter();
        let of_4 = of_4.flat_map(|&at| LIES_OF_4.map(|length| lie(at, &length.to_le_bytes())));
        let of_8 = self.lengths_of_8.iter();
        let of_8 = of_8.flat_map(|&at| LIES_OF_8.map(|length| lie(at, &length.to_le_bytes())));
        of_4.chain(of_8).collect()
    }
}

/// A body of every kind of record of MCAP, by its opcode.
fn kinds() -> Vec<(u8, Body)> {
    let body = Body::default;
    vec![
        (op::HEADER, body().text("lightloom").text("library")),
        (op::FOOTER, body().numbers(20)),
        (op::SCHEMA, body().numbers(2).text("name").text("jsonschema").data_of_4(b"{}")),
        (op::CHANNEL, body().numbers(4).text("/log").text("json").map(&[("key", "value"), ("b", "")])),
        (op::MESSAGE, body().numbers(22)),
        (op::CHUNK, body().numbers(28).text("").data_of_8(&[])),
        (op::MESSAGE_INDEX, body().numbers(2).data_of_4(&[0; 32])),
        (op::CHUNK_INDEX, body().numbers(32).data_of_4(&[0; 10]).numbers(8).text("zstd").numbers(16)),
        (op::ATTACHMENT, body().numbers(16).text("name").text("text/plain").data_of_8(b"data").numbers(4)),
        (op::ATTACHMENT_INDEX, body().numbers(40).text("name").text("text/plain")),
        (op::STATISTICS, body().numbers(42).data_of_4(&[0; 10])),
        (op::METADATA, body().text("other").map(&[("key", "value"), ("b", "")])),
        (op::METADATA_INDEX, body().numbers(16).text("name")),
        (op::SUMMARY_OFFSET, body().numbers(17)),
        (op::DATA_END, body().numbers(4)),
        (0x90, body().numbers(5)),
    ]
}

fn record(opcode: u8, length: u64, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &length.to_le_bytes(), body].concat()
}

fn honest(opcode: u8, body: &Body) -> Vec<u8> {
    record(opcode, body.bytes.len() as u64, &body.bytes)
}

/// The beginning of a tape, and then these records.
fn tape_with(records: &[u8]) -> Vec<u8> {
    let header = Body::default().text("lightloom").text("");
    let head = Body::default().text("lightloom").map(&[("format", "1"), ("show", "a lie")]);
    [mcap::MAGIC, &honest(op::HEADER, &header), &honest(op::METADATA, &head), records].concat()
}

/// A chunk of these records that claims to have some size when unpacked.
fn chunk(records: &[u8], compression: &str, claimed: u64) -> Vec<u8> {
    let data =
        if compression.is_empty() { records.to_vec() } else { zstd::bulk::compress(records, 1).unwrap() };
    let mut body = Body::default().numbers(16);
    body.bytes.extend(claimed.to_le_bytes());
    body.bytes.extend(crc32fast::hash(records).to_le_bytes());
    honest(op::CHUNK, &body.text(compression).data_of_8(&data))
}

/// Why a tape ends, or is none; and the memory that it took to find out.
fn told(path: &Path, bytes: &[u8]) -> (Option<String>, usize) {
    std::fs::write(path, bytes).unwrap();
    let mut ending = None;
    let read = || -> Result<Option<String>, TapeError> {
        let tape = Tape::open(path)?;
        black_box(info(path)?);
        Ok(tape.records().find_map(Result::err).map(|error| error.to_string()))
    };
    let taken = held(|| ending = read().unwrap_or_else(|error| Some(error.to_string())));
    (ending, taken)
}

/// The file is refused in one sentence that says this, and costs no more memory than its length and a chunk allow.
fn is_refused(path: &Path, bytes: &[u8], what: &str, case: &str) {
    let (ending, taken) = told(path, bytes);
    let ending = ending.unwrap_or_else(|| panic!("{case}: nothing is said"));
    assert!(ending.contains(what) && !ending.contains('\n'), "{case}: {ending}");
    let limit = CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len();
    assert!(taken <= limit, "{case}: {taken} bytes for {}: {ending}", bytes.len());
}

/// Where lying records stand: in the file, or in a chunk of it.
const PLACES: [&str; 3] = ["the file", "a chunk", "a packed chunk"];

fn placed(place: &str, records: &[u8]) -> Vec<u8> {
    match place {
        "the file" => tape_with(records),
        "a chunk" => tape_with(&chunk(records, "", records.len() as u64)),
        _ => tape_with(&chunk(records, "zstd", records.len() as u64)),
    }
}

#[test]
fn no_length_is_believed() {
    let _turn = TURN.lock();
    assert!(held(|| drop(black_box(vec![0_u8; 1 << 20]))) >= 1 << 20, "the canary: memory is counted");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lie.mcap");
    for (place, (opcode, body)) in
        PLACES.into_iter().flat_map(|place| kinds().into_iter().map(move |kind| (place, kind)))
    {
        let case = format!("kind {opcode:#x} in {place}");
        let (ending, _) = told(&path, &placed(place, &honest(opcode, &body)));
        let is_read = ending.as_ref().is_none_or(|ending| !ending.contains("claims"));
        assert!(is_read, "the canary: an honest {case} is read: {ending:?}");
        for length in LIES_OF_8 {
            let bytes = placed(place, &record(opcode, length, &body.bytes));
            is_refused(&path, &bytes, "claims", &format!("{case}, of {length} bytes"));
        }
        for lie in body.lies() {
            let bytes = placed(place, &record(opcode, lie.len() as u64, &lie));
            is_refused(&path, &bytes, "claims", &case);
        }
        for length in 0..body.bytes.len() {
            let cut = record(opcode, length as u64, &body.bytes[..length]);
            let (_, taken) = told(&path, &placed(place, &cut));
            assert!(taken <= CONSTANT_BYTES + BYTES_PER_BYTE * 1000, "{case}, cut at {length}");
        }
    }
}

#[test]
fn a_chunk_gets_no_more_than_chunks_may_have() {
    let _turn = TURN.lock();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("chunk.mcap");
    let records = honest(0x90, &Body::default().numbers(1000));
    for compression in ["", "zstd"] {
        for claimed in [LARGEST_CHUNK_BYTES + 1, 1 << 32, 1 << 62, u64::MAX] {
            let bytes = tape_with(&chunk(&records, compression, claimed));
            is_refused(&path, &bytes, "claims", &format!("a chunk of {claimed} bytes, {compression}"));
        }
        let bytes = tape_with(&chunk(&records, compression, LARGEST_CHUNK_BYTES));
        let (ending, taken) = told(&path, &bytes);
        assert!(ending.is_some_and(|ending| ending.contains("claims")), "it holds less");
        let limit = LARGEST_CHUNK_BYTES as usize + CONSTANT_BYTES + BYTES_PER_BYTE * bytes.len();
        assert!(taken <= limit, "{taken} bytes for a chunk, {compression}");
    }
    // A packed chunk that holds more than it claims.
    let bytes = tape_with(&chunk(&vec![0; 1 << 24], "zstd", 1000));
    is_refused(&path, &bytes, "chunk", "a chunk that holds more");
}
