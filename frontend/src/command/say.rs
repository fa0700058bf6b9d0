//! What commands print.

use std::io::Write;

/// Prints on standard output. Unlike `println!` it does not panic where nobody reads it any more.
pub(super) fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    // Whoever closed standard output does not want the rest.
    let _ = writeln!(out, "{text}").and_then(|()| out.flush());
}

/// Prints a warning on standard error.
pub(super) fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "lightloom: warning: {text}");
}
