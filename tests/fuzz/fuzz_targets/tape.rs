//! Opens a hostile tape: what is on it, its records, a cut of it, and its table.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use std::fs;
use std::hint::black_box;
use std::sync::LazyLock;
use tape::{Format, Tape, cut, export, info};
use tempfile::TempDir;

/// Memory beside what grows with a tape: the 16 MiB that a chunk may have, and as much for the writer of a cut.
const CONSTANT_BYTES: usize = 32 << 20;
/// Memory per byte of a tape: a cut keeps what waits for the next frame, which chunks packed by Zstandard hold.
const BYTES_PER_BYTE: usize = 1 << 12;
/// Seconds of the part that is cut out.
const PART: std::ops::Range<f64> = 0.5..1.5;

/// The folder of this process; `run` removes it.
static FOLDER: LazyLock<TempDir> =
    LazyLock::new(|| tempfile::tempdir().expect("a folder for temporary files"));

fuzz_target!(|data: &[u8]| {
    let (path, part) = (FOLDER.path().join("input.mcap"), FOLDER.path().join("part.mcap"));
    if fs::write(&path, data).is_err() {
        return;
    }
    let _budget = Budget::new(CONSTANT_BYTES + BYTES_PER_BYTE * data.len());
    if let Ok(tape) = Tape::open(&path) {
        let _ = black_box(tape.head());
        tape.records().for_each(|record| drop(black_box(record)));
    }
    drop(black_box(info(&path)));
    drop(black_box(cut(&path, &part, PART)));
    for format in [Format::Csv, Format::Json] {
        drop(black_box(export(&path, format, &mut std::io::sink())));
    }
});
