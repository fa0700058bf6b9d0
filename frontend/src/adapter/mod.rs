//! Where the commands meet what they drive: displays, volumes, importers, exporters and back-ends.

mod backends;
mod display;
mod exhibit;
mod export;
mod import;
mod levels;
mod replay;
mod store;
mod trace;
mod volume;

pub use backends::{BackendOptions, Backends, Drawing, Showing, dismiss_backends};
pub use display::{check_outputs, load_display, preset_displays};
pub use exhibit::{is_exhibit, open_exhibit};
pub use export::{ExportSummary, export};
pub use import::{ImportRequest, ImportSummary, RawRequest, Skipped, import};
pub use levels::LevelSummary;
pub use replay::{ReplayRow, Traces};
pub use store::{StoreSummary, VerifySummary, store_summary, verify};
pub use trace::TraceFolder;
pub use volume::{looks_of, meet_volume, open_scene_volume};
