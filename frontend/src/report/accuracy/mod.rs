//! What `lightloom accuracy` found, as JSON for programs, as a page and as a table for people.

mod comparison;
mod findings;
mod page;
mod plots;
mod table;

pub use comparison::{Comparison, Measure};
pub use findings::AccuracyReport;
pub use table::terminal_table;

use super::write_text;
use crate::FrontendError;
use std::path::Path;

/// The report for programs, in the output folder.
pub const JSON: &str = "accuracy.json";
/// The report for people, in the output folder.
pub const HTML: &str = "accuracy.html";

/// Writes JSON and page into a folder that is there, each whole or not at all.
pub fn write(report: &AccuracyReport, out: &Path) -> Result<(), FrontendError> {
    write_text(&out.join(JSON), &serde_json::to_string_pretty(report)?)?;
    write_text(&out.join(HTML), &page::page(report))?;
    Ok(())
}
