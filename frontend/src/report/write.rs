//! The report of a run on its way to its files.

use super::{HTML, JSON, Report, page, write_text};
use crate::FrontendError;
use std::path::Path;

/// Writes both reports; the page holds the pictures that it shows.
pub fn write(report: &Report, out: &Path) -> Result<(), FrontendError> {
    write_text(&out.join(JSON), &serde_json::to_string_pretty(report)?)?;
    write_text(&out.join(HTML), &page::page(report, out)?)?;
    Ok(())
}
