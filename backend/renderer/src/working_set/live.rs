//! The live working set: what rays met goes in, what to load comes out, a little every frame.
//!
//! Pure: it knows no device, no file and no clock of its own. Each frame is one [`WorkingSet::update`], after which
//! [`WorkingSet::wanted`] lists which bricks to fetch, most needed first; what became of them comes back through
//! [`WorkingSet::arrived`] and [`WorkingSet::failed`], and [`WorkingSet::show`] moves what rays meet.

use super::presence::{Seen, Tick, advance, refresh, refresh_deficits};
use super::room::Room;
use super::{
    Cut, CutNode, Family, HORIZON, IndexRules, MOST_AHEAD, Meeting, Motion, ResidentBrick, Retry, SlotPool,
    prefetch, priorities,
};
use bricks::LodRule;
use bricks::is_shown;
use bricks::{BrickErrorKind, NodeKey, NodeSummary};
use optics::Optics;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::time::Duration;

/// Rays that met a node within this many seconds still count, for views that move. What is no longer
/// seen should not take room for longer, and a node that few rays meet should not come and go with each of them.
const MEMORY_S: f64 = 0.1;
/// Rays of this many frames count, however long they take: a device reports what rays met some frames later.
const MEMORY_FRAMES: usize = 5;

/// What is asked of an update besides the rules of the frame.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The rules of the frame.
    pub rules: IndexRules<'a>,
    /// Bounds of the values of a node inside the volume.
    pub summary: &'a dyn Fn(NodeKey) -> NodeSummary,
    /// Now, seconds on a clock that does not run back.
    pub now_s: f64,
    /// Whether nothing has changed since the last frame but the time.
    pub is_still: bool,
    /// Time in which detail appears or goes, seconds; 0 is at once.
    pub fade_s: f64,
    /// Bricks that may be asked for and not be there yet.
    pub most_in_flight: usize,
}

/// A leaf that rays of the last frame met, in any view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Which node.
    pub key: NodeKey,
    /// Rays that sampled it.
    pub rays: u32,
}

/// What became of a brick that has arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// It belongs into this slot.
    Slot(u32),
    /// It is no longer wanted.
    Unwanted,
}

/// A node that something is wanted of.
struct Wish {
    urgency: f64,
    rays: u32,
    key: NodeKey,
    place: u32,
}

impl Wish {
    /// By urgency, then by rays, then by key.
    fn most_needed_first(a: &Self, b: &Self) -> Ordering {
        b.urgency.total_cmp(&a.urgency).then(b.rays.cmp(&a.rays)).then(a.key.cmp(&b.key))
    }
}

/// The cut, the slots of its bricks, and what is on its way.
#[derive(Clone, Debug)]
pub struct WorkingSet {
    /// The cut.
    pub cut: Cut,
    /// The slots.
    pub slots: SlotPool,
    /// When the view came to rest; the present while it moves.
    still_since_s: f64,
    now_s: f64,
    /// The times of the latest updates, the present last.
    updates_s: [f64; MEMORY_FRAMES],
    last_s: Option<f64>,
    /// What scalars looked like in the last update.
    optics: Option<Optics>,
    retry: Retry,
    /// Of split nodes: how urgent that was, for them or for the finer neighbours that needed it.
    urgency: HashMap<NodeKey, f64>,
    wanted: Vec<NodeKey>,
    /// Families that came in the last update.
    pub splits: u64,
    /// Families that went in the last update.
    pub collapses: u64,
    /// Resident leaves whose shares have not come to rest.
    pub moving: u64,
}

impl WorkingSet {
    /// The root alone, with `slots` slots for bricks.
    pub fn new(root: NodeSummary, slots: u32) -> Self {
        Self {
            cut: Cut::new(root),
            slots: SlotPool::new(slots),
            still_since_s: 0.0,
            now_s: 0.0,
            updates_s: [0.0; MEMORY_FRAMES],
            last_s: None,
            optics: None,
            retry: Retry::new(),
            urgency: HashMap::new(),
            wanted: Vec::new(),
            splits: 0,
            collapses: 0,
            moving: 0,
        }
    }

    /// Takes in what rays met, and splits and collapses within the cache: the largest deficit first, then the most rays,
    /// then by key. Touching nodes differ by one level at most, before and after.
    pub fn update(&mut self, moment: &Moment, met: &[Met]) {
        self.tell_time(moment);
        (self.splits, self.collapses) = (0, 0);
        let mut order: Vec<u32> = self.cut.walk().collect();
        if self.optics.as_ref() == Some(moment.rules.optics) {
            refresh_deficits(&mut self.cut, &moment.rules, &order);
        } else {
            refresh(&mut self.cut, &moment.rules, &order);
            self.optics = Some(moment.rules.optics.clone());
        }
        self.note(met);
        self.drop_unwanted(moment, &order);
        order.clear();
        order.extend(self.cut.walk());
        let met = |place| self.is_met(place).then(|| self.cut.node(place).deficit);
        let priority = priorities(&self.cut, &order, met);
        self.split_all(moment, &order, &priority);
        self.wanted = self.missing(&priority);
    }

    /// Gives up all detail and all that is known, the time included: the root alone stays.
    pub fn restart(&mut self) {
        (self.still_since_s, self.now_s, self.last_s) = (0.0, 0.0, None);
        self.updates_s = [0.0; MEMORY_FRAMES];
        (self.optics, self.retry) = (None, Retry::new());
        self.urgency.clear();
        self.cut.node_mut(0).met = Meeting::NEVER;
        if self.cut.node(0).first_child.is_some() {
            for slot in self.cut.collapse_all(0) {
                self.slots.give(slot);
            }
        }
    }

    /// Bricks to fetch, most needed first.
    pub fn wanted(&self) -> &[NodeKey] {
        &self.wanted
    }

    /// Gives a brick that has come its slot.
    pub fn arrived(&mut self, key: NodeKey, low: f64, span: f64) -> Arrival {
        self.retry.came(key);
        let place = self.cut.find(key);
        if self.cut.node(place).key != key || !self.cut.lacks(place) {
            return Arrival::Unwanted;
        }
        let Some(slot) = self.slots.take() else { return Arrival::Unwanted };
        self.cut.set_brick(place, ResidentBrick { slot, low, span });
        Arrival::Slot(slot)
    }

    /// Notes that a brick could not be read: its family is not asked for until it is worth another try. Returns whether this
    /// is the brick's first failure.
    pub fn failed(&mut self, key: NodeKey, kind: BrickErrorKind) -> bool {
        self.retry.failed(key, kind, self.now_s)
    }

    /// Bricks that the motion since an earlier frame, of which this is the rule and the time, will ask for, if it goes on,
    /// of the leaves that rays meet.
    pub fn ahead(
        &self,
        moment: &Moment,
        leaves: impl IntoIterator<Item = NodeKey>,
        before: Option<(LodRule, f64)>,
    ) -> Vec<NodeKey> {
        let Some((before, then_s)) = before.filter(|&(_, then_s)| then_s < moment.now_s) else {
            return Vec::new();
        };
        let between = Duration::try_from_secs_f64(moment.now_s - then_s).unwrap_or(Duration::MAX);
        let rules = &moment.rules;
        let motion = Motion { now: rules.lod, before: &before, between };
        let lacks = |key: NodeKey| {
            let node = self.cut.node(self.cut.find(key));
            let is_resident = node.key == key && node.brick.is_some();
            !is_resident && self.may_ask(key) && is_shown(rules.optics, (moment.summary)(key))
        };
        prefetch(leaves, &motion, HORIZON, rules.shape, lacks, MOST_AHEAD)
    }

    /// Moves what rays meet on to the present, `fade_s` being the time of a whole fade.
    pub fn show(&mut self, moment: &Moment) {
        let order: Vec<u32> = self.cut.walk().collect();
        let step = match self.last_s {
            _ if moment.fade_s <= 0.0 => 1.0,
            None => 0.0,
            Some(last) => ((moment.now_s - last) / moment.fade_s).clamp(0.0, 1.0) as f32,
        };
        self.last_s = Some(moment.now_s);
        let tick = Tick { now_s: self.now_s, step, seen: self.seen() };
        let is_lost = |key| !self.retry.may_ask_below(key, tick.now_s);
        self.moving = advance(&mut self.cut, moment.rules.shape, &order, &tick, is_lost);
    }

    /// Whether the detail below a node is known to be unreadable for now.
    pub fn is_lost(&self, key: NodeKey) -> bool {
        !self.retry.may_ask_below(key, self.now_s)
    }

    /// Whether leaves have to blend even where the display resolves the same everywhere: some fade, or rays meet what is
    /// too coarse beside what has come or found room.
    pub fn blends(&self) -> bool {
        let is_short = |place: u32| {
            let node = self.cut.node(place);
            node.is_visible && node.deficit > 0.0 && node.permits < 1.0
        };
        self.moving > 0 || self.cut.shown_leaves().any(is_short)
    }

    /// Bricks that slots are kept for.
    pub fn reserved(&self) -> usize {
        self.cut.walk().filter(|&place| self.awaits(place)).count()
    }

    fn tell_time(&mut self, moment: &Moment) {
        self.now_s = self.now_s.max(moment.now_s);
        self.updates_s.rotate_left(1);
        self.updates_s[MEMORY_FRAMES - 1] = self.now_s;
        if !moment.is_still {
            self.still_since_s = self.now_s;
        }
    }

    /// Since when rays count: while nothing changes, all of them do, so that what is chosen by them comes to rest.
    pub(super) fn seen(&self) -> Seen {
        let new_since_s = self.updates_s[0].min(self.now_s - MEMORY_S);
        Seen { met_since_s: self.still_since_s.min(new_since_s), new_since_s }
    }

    /// Whether rays met a node, be it that they meet its children now.
    pub(super) fn has_met(&self, place: u32) -> bool {
        let node = self.cut.node(place);
        node.is_visible && self.seen().has_met(node)
    }

    /// Whether a node is a leaf that rays meet.
    fn is_met(&self, place: u32) -> bool {
        self.cut.node(place).shown_child().is_none() && self.has_met(place)
    }

    fn note(&mut self, met: &[Met]) {
        for &Met { key, rays } in met {
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

    /// Whether a brick may be asked for, with its family.
    fn may_ask(&self, key: NodeKey) -> bool {
        let alone = || self.retry.may_ask(key, self.now_s);
        key.parent().map_or_else(alone, |parent| !self.is_lost(parent))
    }

    /// Gives up families that are on their way and no longer wanted, fine ones first.
    fn drop_unwanted(&mut self, moment: &Moment, order: &[u32]) {
        let seen = self.seen();
        for &place in order.iter().rev() {
            let node = self.cut.node(place);
            let Some(first) = node.first_child else { continue };
            let lacks = (first..first + 8).any(|child| self.cut.lacks(child));
            let is_wanted = node.deficit > 0.0 && seen.has_met(node) && !self.is_lost(node.key);
            let is_leaving = node.is_leaving && node.family == Family::Hidden;
            if ((lacks && !is_wanted) || is_leaving) && self.cut.may_collapse(moment.rules.shape, place) {
                self.collapse(place);
            }
        }
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
    }

    /// Splits all that rays found too coarse, as far as there is room.
    fn split_all(&mut self, moment: &Moment, order: &[u32], priority: &[f64]) {
        let is_candidate = |&place: &u32| self.is_candidate(place);
        let mut candidates: Vec<Wish> = order
            .iter()
            .copied()
            .filter(is_candidate)
            .map(|place| self.wish(place, priority[place as usize], self.cut.node(place).met.rays))
            .collect();
        candidates.sort_by(Wish::most_needed_first);
        let mut room = Room::new(self, moment, priority);
        room.pay_debts(self);
        for Wish { urgency, key, place, .. } in candidates {
            // Another may have needed it split, or needed its room.
            if self.cut.find(key) != place || self.cut.node(place).first_child.is_some() {
                continue;
            }
            for split in room.make(self, place, urgency) {
                self.split(moment, split);
                self.urgency.insert(self.cut.node(split).key, urgency);
            }
            if room.is_exhausted() {
                break;
            }
        }
    }

    fn is_candidate(&self, place: u32) -> bool {
        let node: &CutNode = self.cut.node(place);
        node.first_child.is_none()
            && node.is_visible
            && node.brick.is_some()
            && node.deficit > 0.0
            && self.is_met(place)
            && !self.is_lost(node.key)
    }

    fn split(&mut self, moment: &Moment, place: u32) {
        let rules = &moment.rules;
        let contains = |key| rules.shape.contains(key).then(|| (moment.summary)(key));
        let first = self.cut.split(place, contains);
        let family: Vec<u32> = (first..first + 8).collect();
        refresh(&mut self.cut, rules, &family);
        self.splits += 1;
    }

    /// Visible nodes without a brick, most urgent families first.
    fn missing(&self, priority: &[f64]) -> Vec<NodeKey> {
        let mut missing = Vec::new();
        for place in self.cut.walk().filter(|&place| self.awaits(place)) {
            let (urgency, rays) = match self.cut.node(place).parent {
                None => (f64::INFINITY, 0),
                Some(parent) => {
                    let above = self.cut.node(parent);
                    let split = self.urgency.get(&above.key).copied().unwrap_or(f64::NEG_INFINITY);
                    let own = priority.get(parent as usize).copied().unwrap_or(f64::NEG_INFINITY);
                    (own.max(split), above.met.rays)
                }
            };
            missing.push(self.wish(place, urgency, rays));
        }
        missing.sort_by(Wish::most_needed_first);
        missing.into_iter().map(|wish| wish.key).collect()
    }

    fn wish(&self, place: u32, urgency: f64, rays: u32) -> Wish {
        Wish { urgency, rays, key: self.cut.node(place).key, place }
    }
}
