//! Which bricks are resident: the cut through the octree, the index rays traverse, the loader.

#[cfg(test)]
mod continuity_tests;
mod cut;
mod in_flight;
mod index;
mod live;
#[cfg(test)]
mod live_tests;
mod loader;
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
mod shortfall;
mod slots;
#[cfg(test)]
mod test_world;
mod touched;
mod touching;
mod trace;
mod vertices;
mod weights;

pub use cut::{Cut, CutNode, Family, Meeting, ResidentBrick};
pub use in_flight::most_in_flight;
pub use index::{IndexRules, build_index};
pub use live::{Arrival, Met, Moment, WorkingSet};
pub use loader::{Fetched, LoadedBrick, Loader, LoaderCounts, PANTRY_BYTES, SAMPLE_BYTES};
pub use prefetch::{HORIZON, MOST_AHEAD, Motion, prefetch};
pub use presence::{Tick, advance, refresh, settle};
pub use priority::priorities;
pub use replay::{Account, DiskModel, FetchOrder, Policy, ReplayRun, ReplayVolume, ReplayedFrame, replay};
pub use retry::Retry;
pub use shortfall::Shortfall;
pub use slots::SlotPool;
pub use touched::{Touched, Wanted};
pub use touching::neighbours;
pub use trace::{
    Demand, Demanded, Seen, TraceError, TraceHeader, TraceReader, TraceWriter, TracedFrame, feedback_on,
};
pub use vertices::{Around, BEYOND, visit_vertices};
pub use weights::{corner_weights, settled_weights};
