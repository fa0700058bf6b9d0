//! What a run reports of itself, as JSON for programs and as a page for people.

pub mod accuracy;
mod backend;
mod files;
mod frame;
mod histogram;
pub(crate) mod html;
mod legend;
mod live;
mod memory;
pub(crate) mod page;
pub mod plot;
mod run;
mod stage_bar;
mod text_file;
pub mod units;
mod upkeep;
mod write;

pub use backend::BackendSummary;
pub use files::{CONTACT_SHEET, FILES, HTML, JSON};
pub use frame::{FrameSummary, Totals};
pub use histogram::{Histogram, Quantiles};
pub use legend::LEGEND;
pub(crate) use legend::write_legend;
pub use live::LiveSummary;
pub use memory::peak_memory_bytes;
pub use run::{DebugSummary, DisplaySummary, EyeSummary, Report, SceneSummary, Subject};
pub(crate) use text_file::write_text;
pub use write::write;
