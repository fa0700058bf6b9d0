//! What a working set holds: the cut, the slots of its bricks, what cannot be read, and since when rays count.

use super::{Beside, Cut, Family, Feedback, Meeting, Memory, Moment, Retry, SlotPool};
use bricks::NodeKey;
use std::collections::HashMap;

/// Rays that met a node within this many seconds still count, for views that move. What nobody sees any more should not
/// take room for longer, and a node that few rays meet should not come and go with each of them.
const MEMORY_S: f64 = 0.1;
/// Rays of this many frames count, however long they take: what rays met is known some frames later.
const MEMORY_FRAMES: usize = 5;
/// By how much the clock goes on from one view of a complete frame to the next, seconds: just enough to tell them apart.
const VIEW_S: f64 = 1e-6;

/// The part of a working set that splits, collapses and the search for room have in common.
#[derive(Clone, Debug)]
pub(super) struct Holdings {
    pub(super) cut: Cut,
    pub(super) slots: SlotPool,
    pub(super) retry: Retry,
    /// Of split nodes: how urgent that was, for them or for the finer neighbours that needed it.
    pub(super) urgency: HashMap<NodeKey, f64>,
    /// Families that went in the last update.
    pub(super) collapses: u64,
    /// Changes so far of what rays meet, or may.
    pub(super) revision: u64,
    pub(super) now_s: f64,
    /// When the view came to rest; the present while it moves.
    still_since_s: f64,
    /// Since when rays count, where one view has the cache to itself.
    view_since_s: Option<f64>,
    /// The times of the latest updates, the present last.
    updates_s: [f64; MEMORY_FRAMES],
}

impl Holdings {
    pub(super) fn new(cut: Cut, slots: u32) -> Self {
        Self {
            cut,
            slots: SlotPool::new(slots),
            retry: Retry::new(),
            urgency: HashMap::new(),
            collapses: 0,
            revision: 0,
            now_s: 0.0,
            still_since_s: 0.0,
            view_since_s: None,
            updates_s: [0.0; MEMORY_FRAMES],
        }
    }

    pub(super) fn start_update(&mut self, moment: &Moment) {
        self.now_s = self.now_s.max(moment.now_s);
        self.updates_s.rotate_left(1);
        self.updates_s[MEMORY_FRAMES - 1] = self.now_s;
        if !moment.is_still {
            self.still_since_s = self.now_s;
        }
        self.collapses = 0;
    }

    /// From now on only rays of this view count, until [`Holdings::share_views`].
    pub(super) fn begin_view(&mut self, now_s: f64) {
        self.now_s = (self.now_s + VIEW_S).max(now_s);
        self.view_since_s = Some(self.now_s);
    }

    /// Rays of all views count.
    pub(super) fn share_views(&mut self) {
        self.view_since_s = None;
    }

    /// Since when rays count: while nothing changes, all of them do, so that what is chosen by them comes to rest.
    pub(super) fn memory(&self) -> Memory {
        if let Some(since_s) = self.view_since_s {
            return Memory { met_since_s: since_s, new_since_s: since_s };
        }
        let new_since_s = self.updates_s[0].min(self.now_s - MEMORY_S);
        Memory { met_since_s: self.still_since_s.min(new_since_s), new_since_s }
    }

    /// Whether rays met a node, be it that they meet its children now.
    pub(super) fn has_met(&self, place: u32) -> bool {
        let node = self.cut.node(place);
        node.is_visible && self.memory().has_met(node)
    }

    /// Whether rays met a node, or what blends down to it.
    pub(super) fn is_near_rays(&self, place: u32) -> bool {
        self.cut.node(place).beside == Beside::Finer || self.has_met(place)
    }

    /// Whether rays of all views count, as in live frames.
    pub(super) fn shares_views(&self) -> bool {
        self.view_since_s.is_none()
    }

    /// Whether a node is a leaf that rays meet.
    pub(super) fn is_met(&self, place: u32) -> bool {
        self.cut.node(place).shown_child().is_none() && self.has_met(place)
    }

    pub(super) fn note(&mut self, met: &[Feedback]) {
        for &Feedback { key, rays, .. } in met {
            let place = self.cut.find(key);
            let now_s = self.now_s;
            let node = self.cut.node_mut(place);
            if node.key == key {
                node.met = Meeting { time_s: now_s, rays, ..node.met };
            }
        }
    }

    /// Whether a slot is kept for a node's brick.
    pub(super) fn awaits(&self, place: u32) -> bool {
        self.cut.lacks(place) && self.may_ask(self.cut.node(place).key)
    }

    /// Bricks that slots are kept for.
    pub(super) fn reserved(&self) -> usize {
        self.cut.walk().filter(|&place| self.awaits(place)).count()
    }

    /// Whether a brick may be asked for, with its family.
    pub(super) fn may_ask(&self, key: NodeKey) -> bool {
        let alone = || self.retry.may_ask(key, self.now_s);
        key.parent().map_or_else(alone, |parent| !self.is_lost(parent))
    }

    /// Whether the detail below a node is known to be out of reach now.
    pub(super) fn is_lost(&self, key: NodeKey) -> bool {
        !self.retry.may_ask_below(key, self.now_s)
    }

    /// Makes a node a leaf again. What its children knew of rays it knows then, and neighbours
    /// find at their corners what they found there before.
    pub(super) fn collapse(&mut self, place: u32) {
        let node = self.cut.node(place);
        let (key, was_shown) = (node.key, node.family != Family::Hidden);
        let first = node.first_child.expect("only an inner node is collapsed");
        let shown = self.cut.node(first).shown;
        self.cut.inherit_meeting(place);
        for slot in self.cut.collapse(place) {
            self.slots.give(slot);
        }
        if was_shown {
            self.cut.node_mut(place).permits = shown;
        }
        self.urgency.remove(&key);
        self.collapses += 1;
        self.revision += 1;
    }
}
