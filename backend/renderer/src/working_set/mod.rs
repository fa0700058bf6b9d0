//! Which bricks are resident: the cut through the octree, the index rays traverse, the loader.

mod beside;
#[cfg(test)]
mod continuity_tests;
mod cut;
mod expected;
mod feedback;
mod holdings;
mod in_flight;
mod index;
mod loader;
mod moment;
mod prefetch;
mod presence;
mod priority;
mod replay;
#[cfg(test)]
mod rest_tests;
mod retry;
mod room;
#[cfg(test)]
mod room_tests;
mod set;
#[cfg(test)]
mod set_tests;
mod shortfall;
mod slots;
mod succession;
#[cfg(test)]
mod test_world;
mod touching;
mod trace;
mod vertices;
mod weights;

pub use cut::{Beside, Cut, CutNode, Family, Meeting, ResidentBrick};
pub use feedback::Feedback;
pub use in_flight::most_in_flight;
pub use index::{IndexRules, build_index};
pub use loader::{Fetched, LoadedBrick, Loader, LoaderCounts, PANTRY_BYTES, SAMPLE_BYTES};
pub use moment::Moment;
pub use prefetch::{HORIZON, MOST_AHEAD, Motion, prefetch};
pub use presence::{Memory, Tick, advance, refresh, settle};
pub use priority::priorities;
pub use replay::{Account, DiskModel, FetchOrder, Policy, ReplayRun, ReplayVolume, ReplayedFrame, replay};
pub use retry::Retry;
pub use set::{Arrival, Showing, Supply, WorkingSet};
pub use shortfall::Shortfall;
pub use slots::SlotPool;
pub use touching::neighbours;
pub use trace::{
    Demand, Demanded, TraceError, TraceHeader, TraceReader, TraceWriter, TracedFrame, feedback_on,
};
pub use vertices::{Around, BEYOND, visit_vertices};
pub use weights::{corner_weights, settled_weights};
