//! Which bricks are resident: the cut through the octree, the index rays traverse, the loader.

mod cut;
mod index;
mod loader;
mod lod;
mod prefetch;
mod retry;
mod slots;
mod touched;

pub use cut::{Cut, CutNode, ResidentBrick};
pub use index::{IndexRules, build_index, is_shown};
pub use loader::{Fetched, LoadedBrick, Loader, LoaderCounts, SAMPLE_BYTES};
pub use lod::LodRule;
pub use prefetch::{Motion, prefetch};
pub use retry::Retry;
pub use slots::SlotPool;
pub use touched::{Touched, Wanted};
