//! Traces played to a working set of another policy: what it would have loaded, and how coarse it would have shown things.
//!
//! No device, no voxels and no clock: each frame does to the working set what the renderer's live frame does, bricks come
//! from a disk in simulated time through the queue of the real loader, and rays ask for what the trace says. So the same
//! trace and policy give the same figures, apart from the time of an update.
//!
//! What a replay cannot know: a region that the recording only ever showed coarsely counts as met everywhere, hidden parts
//! included, and the brick bounds of damaged bricks are taken as whole. A view counts as still while place, transfer
//! functions and level of detail stay; the renderer looks at the observer and the light, too.

mod account;
mod disk;
#[cfg(test)]
mod greedy_tests;
mod policy;
mod stockroom;
#[cfg(test)]
mod tests;

pub use account::{Account, ReplayRun};
pub use policy::{DiskModel, FetchOrder, Policy};

use super::{
    Feedback, IndexRules, Moment, Shortfall, Showing, TraceHeader, TracedFrame, WorkingSet, feedback_on,
    most_in_flight,
};
use bricks::{NodeKey, NodeSummary, OctreeShape};
use layout::{code_from_deficit, deficit_from_code};
use std::time::Instant;
use stockroom::Stockroom;

/// The volume of a trace, without its voxels.
#[derive(Clone, Copy)]
pub struct ReplayVolume<'a> {
    /// Bounds of the values of a node inside the volume.
    pub summary: &'a dyn Fn(NodeKey) -> NodeSummary,
    /// Bytes of a brick as the disk holds it, on average.
    pub brick_bytes: u64,
}

/// What became of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReplayedFrame {
    /// Its time on the scene's clock, seconds.
    pub time_s: f64,
    /// How coarse it was; None if rays met nothing.
    pub shortfall: Option<Shortfall>,
    /// Bricks that came into the cache.
    pub bricks_loaded: u64,
    /// Those among them that had been there before.
    pub loaded_again: u64,
    /// Bricks in the cache.
    pub bricks_resident: u64,
    /// Families that came.
    pub splits: u64,
    /// Families that went.
    pub collapses: u64,
    /// Time of the update, milliseconds on one core.
    pub update_ms: f64,
}

/// Plays the frames of a trace to a working set that begins with the root alone.
pub fn replay(
    header: &TraceHeader,
    volume: ReplayVolume,
    policy: &Policy,
    frames: &[TracedFrame],
) -> ReplayRun {
    let mut replay = Replay::new(header, volume, *policy);
    let frames = frames.iter().map(|frame| replay.play(frame)).collect();
    let bricks_read = replay.stock.bricks_read();
    ReplayRun { frames, bricks_read, bytes_read: bricks_read * volume.brick_bytes }
}

/// A replay between two frames.
struct Replay<'a> {
    header: &'a TraceHeader,
    volume: ReplayVolume<'a>,
    shape: OctreeShape,
    policy: Policy,
    set: WorkingSet,
    stock: Stockroom,
    last: Option<&'a TracedFrame>,
    /// What rays of the frame before met.
    met: Vec<Feedback>,
}

impl<'a> Replay<'a> {
    fn new(header: &'a TraceHeader, volume: ReplayVolume<'a>, policy: Policy) -> Self {
        let shape = header.shape();
        Self {
            header,
            volume,
            set: WorkingSet::new((volume.summary)(NodeKey::ROOT), policy.slots(&shape)),
            stock: Stockroom::new(policy, volume.brick_bytes),
            shape,
            policy,
            last: None,
            met: Vec::new(),
        }
    }

    /// One frame, as the renderer steps through it.
    fn play(&mut self, frame: &'a TracedFrame) -> ReplayedFrame {
        let (shape, lod) = (self.shape, frame.lod_rule(self.header));
        let is_still = self.last.is_some_and(|last| is_same_view(last, frame));
        let moment = Moment {
            rules: IndexRules::new(&shape, &lod, &frame.optics),
            summary: self.volume.summary,
            now_s: frame.time_s,
            is_still,
            fade_s: Moment::fade_of(self.policy.fade_s, is_still),
            most_in_flight: most_in_flight(self.policy.upload_bytes),
        };
        let before = self.last.map(|last| (last.lod_rule(self.header), last.time_s));
        let started = Instant::now();
        self.stock.open(frame.time_s);
        self.set.step(&moment, &self.met, Showing::InTime { before }, &mut self.stock);
        let update = started.elapsed().saturating_sub(self.stock.busy);
        let shortfall = self.look(frame, &moment.rules);
        self.last = Some(frame);
        ReplayedFrame {
            time_s: frame.time_s,
            shortfall,
            bricks_loaded: self.stock.loaded,
            loaded_again: self.stock.loaded_again,
            bricks_resident: self.set.slots().used(),
            splits: self.set.splits,
            collapses: self.set.collapses(),
            update_ms: update.as_secs_f64() * 1e3,
        }
    }

    /// Casts the trace's rays at what is shown.
    fn look(&mut self, frame: &TracedFrame, rules: &IndexRules) -> Option<Shortfall> {
        let cut = self.set.cut();
        let leaves = cut.shown_leaves().map(|place| cut.node(place));
        let leaves = leaves.filter(|node| node.is_visible).map(|node| node.key);
        self.met = feedback_on(&frame.demand, rules.lod, rules.shape, leaves);
        Shortfall::of(self.met.iter().map(|met| (met.rays, as_coded(met.deficit))))
    }
}

/// A deficit as a feedback table has it; 0 where it is none.
fn as_coded(deficit: f64) -> f64 {
    f64::from(deficit_from_code(code_from_deficit(deficit as f32)).unwrap_or(0.0).max(0.0))
}

/// Whether two frames ask for the same detail.
fn is_same_view(a: &TracedFrame, b: &TracedFrame) -> bool {
    (a.display_from_volume, a.lod_scale) == (b.display_from_volume, b.lod_scale) && a.optics == b.optics
}
