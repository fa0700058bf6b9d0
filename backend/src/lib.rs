//! What both programs open a back-end with: the volume, the renderer, the log.

mod log;
mod open;
mod painting;

pub use log::start_log;
pub use open::{open_renderer, open_volume};
