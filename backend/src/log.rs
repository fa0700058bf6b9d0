//! The log of a program, the same for both programs: a run logs the same whether it is one process or many.

use std::io::{IsTerminal, stderr};
use tracing_subscriber::EnvFilter;

/// Begins the log, on standard error: warnings and worse, of winit errors alone (it warns of any
/// desktop that is not quite usual), or what `LIGHTLOOM_LOG` asks for. Call it once, from `main`.
pub fn start_log() {
    let filter =
        EnvFilter::try_from_env("LIGHTLOOM_LOG").unwrap_or_else(|_| EnvFilter::new("warn,winit=error"));
    // A log in a file is for other programs to read: colours are for a terminal.
    let has_colours = stderr().is_terminal();
    tracing_subscriber::fmt().with_env_filter(filter).with_ansi(has_colours).with_writer(stderr).init();
}
