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
#[cfg(test)]
mod tests;

pub use account::{Account, ReplayRun};
pub use policy::{DiskModel, FetchOrder, Policy};

use super::{
    Arrival, IndexRules, Met, Moment, Shortfall, TraceHeader, TracedFrame, WorkingSet, feedback_on,
    most_in_flight,
};
use bricks::{NodeKey, NodeSummary, OctreeShape};
use disk::Disk;
use layout::{code_from_deficit, deficit_from_code};
use policy::Waiting;
use std::collections::HashSet;
use std::time::Instant;

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
    let bricks_read = replay.disk.bricks_read;
    ReplayRun { frames, bricks_read, bytes_read: bricks_read * volume.brick_bytes }
}

/// A replay between two frames.
struct Replay<'a> {
    header: &'a TraceHeader,
    volume: ReplayVolume<'a>,
    shape: OctreeShape,
    policy: Policy,
    set: WorkingSet,
    disk: Disk,
    waiting: Waiting,
    last: Option<&'a TracedFrame>,
    /// What rays of the frame before met.
    met: Vec<Met>,
    /// Bricks that were in the cache at any time.
    known: HashSet<NodeKey>,
}

impl<'a> Replay<'a> {
    fn new(header: &'a TraceHeader, volume: ReplayVolume<'a>, policy: Policy) -> Self {
        let shape = header.shape();
        Self {
            header,
            volume,
            set: WorkingSet::new((volume.summary)(NodeKey::ROOT), policy.slots(&shape)),
            disk: Disk::new(policy.disk, volume.brick_bytes),
            shape,
            policy,
            waiting: Waiting::default(),
            last: None,
            met: Vec::new(),
            known: HashSet::new(),
        }
    }

    /// One frame, in the order of the renderer's: what rays met, what to fetch, what has come, what is shown.
    fn play(&mut self, frame: &'a TracedFrame) -> ReplayedFrame {
        let (shape, lod) = (self.shape, frame.lod_rule(self.header));
        let moment = Moment {
            rules: IndexRules {
                shape: &shape,
                lod: &lod,
                optics: &frame.optics,
                is_quadrilinear: false,
                blank_slot: None,
            },
            summary: self.volume.summary,
            now_s: frame.time_s,
            is_still: self.last.is_some_and(|last| is_same_view(last, frame)),
            fade_s: self.policy.fade_s,
            most_in_flight: most_in_flight(self.policy.upload_bytes),
        };
        let started = Instant::now();
        self.set.update(&moment, &self.met);
        let mut update = started.elapsed();
        let wanted = self.waiting.ordered(self.policy.order, &self.set);
        let before = self.last.map(|last| (last.lod_rule(self.header), last.time_s));
        let ahead = self.set.ahead(&moment, self.met.iter().map(|met| met.key), before);
        self.disk.run_until(frame.time_s);
        self.disk.want(&wanted, &ahead);
        self.disk.run_until(frame.time_s);
        let (bricks_loaded, loaded_again) = self.take_arrived();
        let started = Instant::now();
        self.set.show(&moment);
        update += started.elapsed();
        let shortfall = self.look(frame, &moment.rules);
        self.last = Some(frame);
        ReplayedFrame {
            time_s: frame.time_s,
            shortfall,
            bricks_loaded,
            loaded_again,
            bricks_resident: self.set.slots.used(),
            splits: self.set.splits,
            collapses: self.set.collapses,
            update_ms: update.as_secs_f64() * 1e3,
        }
    }

    /// Bricks that came into the cache, and those of them that had been there before.
    fn take_arrived(&mut self) -> (u64, u64) {
        let (mut loaded, mut again) = (0, 0);
        for key in self.disk.arrived(self.policy.upload_bytes) {
            if let Arrival::Slot(_) = self.set.arrived(key, 0.0, 0.0) {
                loaded += 1;
                again += u64::from(!self.known.insert(key));
            }
        }
        (loaded, again)
    }

    /// Casts the trace's rays at what is shown.
    fn look(&mut self, frame: &TracedFrame, rules: &IndexRules) -> Option<Shortfall> {
        let cut = &self.set.cut;
        let leaves = cut.shown_leaves().map(|place| (cut.node(place), place));
        let leaves = leaves.filter(|(node, _)| node.is_visible).map(|(node, place)| (node.key, place));
        let seen = feedback_on(&frame.demand, rules.lod, rules.shape, leaves);
        self.met = seen.iter().map(|seen| Met { key: cut.node(seen.place).key, rays: seen.rays }).collect();
        Shortfall::of(seen.iter().map(|seen| (seen.rays, as_told(seen.deficit))))
    }
}

/// What a feedback table would hold for a deficit, if it is one.
fn as_told(deficit: f32) -> f64 {
    f64::from(deficit_from_code(code_from_deficit(deficit)).unwrap_or(0.0).max(0.0))
}

/// Whether two frames ask for the same detail.
fn is_same_view(a: &TracedFrame, b: &TracedFrame) -> bool {
    (a.display_from_volume, a.lod_scale) == (b.display_from_volume, b.lod_scale) && a.optics == b.optics
}
