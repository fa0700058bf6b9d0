//! What host and kernels share: structs byte for byte as WGSL lays them out, bindings, the geometry of a brick.

pub mod binding;
pub mod brick;
mod feedback;
mod node;
mod planes;
pub mod present;
mod scene;
mod table_entry;
mod view;

pub use brick::{CELL_EDGE, CELL_WORDS, CELLS_ACROSS};
pub use feedback::{
    CODE_OF_ZERO, CODES_PER_LEVEL, FeedbackEntry, MOST_DEFICIT, code_from_deficit, deficit_from_code,
};
pub use node::{FULL_WEIGHTS, NO_NODE, NO_SLOT, NodeRecord, pack_weights};
pub use planes::{FanBlock, PLANE_COLUMNS, PlaneBand, PlaneFound, PlaneLayer, PlaneVariation};
pub use present::{PaintBlock, PresentBlock};
pub use scene::{Link, SceneBlock};
pub use table_entry::{ImportanceEntry, IndexEntry, TableCell, TableEntry};
pub use view::{CUT, MISSING, SAMPLE_COUNT, SHORT_RAYS, TALLIED_TILES, TILE_EDGE, TileTally, ViewBlock};
