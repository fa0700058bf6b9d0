//! How a tool's track does with simulated hands: what it takes from jitter, what lag it adds, and what prediction errs.
//!
//! `cargo run --release -p lightloom-tests --example tracking`, or without the page and in a fraction of the time to build
//! `cargo run --release -p tracking --example study`.
//!
//! A tracker of 60 or 120 samples a second, whose times vary by 15 %, errs by 0.3 mm and 0.11° (RMS, along each axis), loses
//! one sample in a hundred and now and then the target for 150 ms. A hand trembles at 8 to 12 Hz by 0.3 mm and 0.17°. All
//! numbers at random come from one seed.

mod study;

use lightloom_tests::results::{Program, Results};

fn main() -> Result<(), String> {
    let mut results = Results::new(Program::Study("tracking"), "tracking", "hands");
    study::tables(&mut |line| results.line(line));
    results.finish()
}
