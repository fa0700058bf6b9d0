//! The structs that kernels read and write, byte for byte as WGSL lays them out.

mod cells;
mod feedback;
mod node;
mod params;
mod table_entry;

pub use cells::{CELL_EDGE, CELL_WORDS, CELLS_ACROSS};
pub use feedback::{FeedbackEntry, code_from_deficit, deficit_from_code};
pub use node::{FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord, pack_weights};
pub use params::{Link, Params, TILE_EDGE};
pub use table_entry::{ImportanceEntry, OpticsEntry};
