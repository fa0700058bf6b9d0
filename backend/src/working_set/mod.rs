//! Which bricks are resident: the cut through the octree, the index rays traverse, the loader.

mod cut;
mod index;
mod loader;
mod lod;
mod slots;
mod touched;
mod trace;

pub use cut::{Cut, CutNode, ResidentBrick};
pub use index::{IndexRules, build_index, is_shown};
pub use loader::{Fetched, LoadedBrick, Loader};
pub use lod::LodRule;
pub use slots::SlotPool;
pub use touched::{Touched, Wanted};
pub use trace::{
    Demand, Demanded, Seen, TraceError, TraceHeader, TraceReader, TraceWriter, TracedFrame, feedback_on,
};
