//! A study of frame control on its way to its files.

use super::{TuneReport, page};
use crate::FrontendError;
use crate::report::write_text;
use renderer::output::write_png;
use std::path::Path;

/// The report for programs.
const JSON: &str = "tune.json";
/// The page for people.
pub const TUNE_HTML: &str = "tune.html";

/// Writes it into a folder.
///
/// # Errors
/// It cannot be written.
pub fn write(report: &TuneReport, folder: &Path) -> Result<(), FrontendError> {
    let mut files = Vec::new();
    for (number, worst) in report.worst.iter().enumerate() {
        let names = ["shown", "truth"].map(|what| format!("worst-{number}-{what}.png"));
        write_png(&folder.join(&names[0]), worst.shown.view()?)?;
        write_png(&folder.join(&names[1]), worst.truth.view()?)?;
        files.push(names);
    }
    write_text(&folder.join(JSON), &serde_json::to_string_pretty(report)?)?;
    Ok(write_text(&folder.join(TUNE_HTML), &page::page(report, folder, &files)?)?)
}
