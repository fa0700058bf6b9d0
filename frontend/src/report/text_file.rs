//! Text on its way into a file, whole or not at all.

use renderer::output::{OutputError, write_atomically};
use std::io::Write;
use std::path::Path;

/// Writes a text.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), OutputError> {
    let failed = |source| OutputError::Write { path: path.to_owned(), source };
    write_atomically(path, |file| file.write_all(text.as_bytes()).map_err(failed))
}
