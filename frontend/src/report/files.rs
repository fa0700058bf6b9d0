//! The files that a run writes beside its pictures, from the output folder.

use super::legend::LEGEND;

/// The report for programs.
pub const JSON: &str = "report.json";
/// The report for people.
pub const HTML: &str = "report.html";
/// The contact sheet of the first frame.
pub const CONTACT_SHEET: &str = "contact-sheet.png";
/// All of them.
pub const FILES: [&str; 4] = [CONTACT_SHEET, LEGEND, JSON, HTML];
