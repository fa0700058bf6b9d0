//! Reads hostile display, exhibit and input files.
#![no_main]

use display_config::Display;
use exhibit::Exhibit;
use inputs::Input;
use libfuzzer_sys::fuzz_target;
use lightloom_fuzz::budget::Budget;
use std::hint::black_box;
use std::path::Path;

/// Memory beside what grows with a file: the tables of a curve, the presets, and a list of faults.
const CONSTANT_BYTES: usize = 8 << 20;
/// Memory per byte of a file: the parser keeps every key and value as a tree with its places.
const BYTES_PER_BYTE: usize = 4096;
/// A longer file teaches nothing that a shorter one does not.
const LONGEST: usize = 1 << 16;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if text.len() > LONGEST {
        return;
    }
    let nowhere = Path::new("/nonexistent");
    let _budget = Budget::new(CONSTANT_BYTES + BYTES_PER_BYTE * text.len());
    match first % 3 {
        0 => drop(black_box(Display::from_toml(text, "input.toml"))),
        1 => drop(black_box(Exhibit::from_toml(nowhere, text, "input.toml"))),
        _ => drop(black_box(Input::from_toml(nowhere, text, "input.toml"))),
    }
});
