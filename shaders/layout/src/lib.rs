//! The structs that kernels read and write, byte for byte as WGSL lays them out.

mod cells;
mod feedback;
mod node;
mod scene;
mod table_entry;
mod view;

pub use cells::{CELL_EDGE, CELL_WORDS, CELLS_ACROSS};
pub use feedback::{FeedbackEntry, code_from_deficit, deficit_from_code};
pub use node::{FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord, pack_weights};
pub use scene::{Link, SceneBlock};
pub use table_entry::{ImportanceEntry, OpticsEntry};
pub use view::{MISSING, TILE_EDGE, ViewBlock};
