//! What commands print.

use crate::FrontendError;
use std::io::{ErrorKind, Write};

/// Prints on standard output. Whoever closed it does not want the rest, and that is no error.
pub fn print(text: &str) -> Result<(), FrontendError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(FrontendError::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// Prints a line on standard output.
pub(super) fn say(text: &str) -> Result<(), FrontendError> {
    print(&format!("{text}\n"))
}

/// Prints a warning on standard error.
pub(super) fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "lightloom: warning: {text}");
}
