//! The working set: what rays met in, what to load out, a little every frame.
//!
//! Pure: it knows no device, no file and no clock of its own. Each frame is one [`WorkingSet::step`]: it takes in what rays
//! met, asks a [`Supply`] for bricks, most needed first, takes in what has come, and moves what rays meet.

use super::beside::{self, mark_beside};
use super::expected::Expected;
use super::holdings::Holdings;
use super::presence::{Tick, advance, refresh, refresh_deficits, settle};
use super::room::Room;
use super::{
    Beside, Cut, CutNode, Family, Feedback, HORIZON, MOST_AHEAD, Moment, Motion, ResidentBrick, SlotPool,
    prefetch, priorities,
};
use bricks::LodRule;
use bricks::is_shown;
use bricks::{BrickErrorKind, NodeKey, NodeSummary};
use optics::Optics;
use std::cmp::Ordering;
use std::time::Duration;

/// What became of a brick that has arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// It belongs into this slot.
    Slot(u32),
    /// Nobody wants it any more.
    Unwanted,
}

/// Where a working set gets its bricks from.
pub trait Supply {
    /// Takes what is [wanted](WorkingSet::wanted) in place of the last list, and what the motion will ask for.
    fn want(&mut self, set: &WorkingSet, ahead: &[NodeKey]);

    /// Hands over what has come, by [`WorkingSet::arrived`] and [`WorkingSet::failed`].
    fn deliver(&mut self, set: &mut WorkingSet);
}

/// How a frame shows what is resident.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Showing {
    /// Detail appears and goes in time; the rule and the time of an earlier frame tell where the motion leads.
    InTime {
        /// Of the frame before, where there was one.
        before: Option<(LodRule, f64)>,
    },
    /// All that the rule of detail asks for is shown, whole and at once: what is shown then depends on nothing else but on
    /// what is resident.
    AtOnce,
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
    pub(super) held: Holdings,
    last_s: Option<f64>,
    /// What scalars looked like in the last update.
    optics: Option<Optics>,
    wanted: Vec<NodeKey>,
    /// What one before it showed.
    pub(super) expected: Expected,
    /// Families that came in the last update.
    pub splits: u64,
    /// Resident leaves whose shares have not come to rest.
    pub moving: u64,
}

impl WorkingSet {
    /// The root alone, with `slots` slots for bricks.
    pub fn new(root: NodeSummary, slots: u32) -> Self {
        Self {
            held: Holdings::new(Cut::new(root), slots),
            last_s: None,
            optics: None,
            wanted: Vec::new(),
            expected: Expected::default(),
            splits: 0,
            moving: 0,
        }
    }

    /// What is resident and shown.
    pub fn cut(&self) -> &Cut {
        &self.held.cut
    }

    #[cfg(test)]
    pub(super) fn cut_mut(&mut self) -> &mut Cut {
        &mut self.held.cut
    }

    /// The slots.
    pub fn slots(&self) -> &SlotPool {
        &self.held.slots
    }

    /// Families that went in the last update.
    pub fn collapses(&self) -> u64 {
        self.held.collapses
    }

    /// A number that is another one whenever what rays meet may have changed but for the rules.
    pub fn revision(&self) -> u64 {
        self.held.revision
    }

    /// One view of a complete frame has the cache to itself: rays of others, before it, do not count.
    pub fn begin_view(&mut self, now_s: f64) {
        self.held.begin_view(now_s);
    }

    /// One frame, or one round of a complete one.
    pub fn step(&mut self, moment: &Moment, met: &[Feedback], showing: Showing, supply: &mut dyn Supply) {
        if let Showing::InTime { .. } = showing {
            self.held.share_views();
        }
        self.update(moment, met);
        let ahead = match showing {
            Showing::InTime { before } => self.ahead(moment, met.iter().map(|met| met.key), before),
            Showing::AtOnce => Vec::new(),
        };
        supply.want(self, &ahead);
        supply.deliver(self);
        match showing {
            Showing::InTime { .. } => self.show(moment),
            Showing::AtOnce => self.settle(moment),
        }
    }

    /// Whether the last step changed nothing, and nothing is on its way or about to go.
    pub fn is_at_rest(&self) -> bool {
        let cut = &self.held.cut;
        let is_leaving = |place: u32| cut.node(place).is_leaving && cut.node(place).first_child.is_some();
        self.splits == 0
            && self.held.collapses == 0
            && self.held.reserved() == 0
            && !cut.walk().any(is_leaving)
    }

    /// Takes in what rays met, and splits and collapses within the cache: the largest deficit first, then the most rays,
    /// then by key. Touching nodes differ by one level at most, before and after.
    pub(super) fn update(&mut self, moment: &Moment, met: &[Feedback]) {
        self.held.start_update(moment);
        self.splits = 0;
        let mut order: Vec<u32> = self.held.cut.walk().collect();
        if self.optics.as_ref() == Some(moment.rules.optics) {
            refresh_deficits(&mut self.held.cut, &moment.rules, &order);
        } else {
            refresh(&mut self.held.cut, &moment.rules, &order);
            self.optics = Some(moment.rules.optics.clone());
            let shows = |key| is_shown(moment.rules.optics, (moment.summary)(key));
            self.held.retry.look_anew(shows);
            self.held.revision += 1;
        }
        self.note_expected();
        self.held.note(met);
        // Complete frames weigh corners by the rule of detail, whatever is resident.
        let memory = self.held.shares_views().then(|| self.held.memory());
        mark_beside(&mut self.held.cut, memory, &order);
        self.drop_unwanted(moment, &order);
        order.clear();
        order.extend(self.held.cut.walk());
        let met = |place| self.needed(place);
        let priority = priorities(&self.held.cut, &order, met);
        self.split_all(moment, &order, &priority);
        self.wanted = self.missing(&priority);
    }

    /// Bricks to fetch, most needed first.
    pub fn wanted(&self) -> &[NodeKey] {
        &self.wanted
    }

    /// Gives a brick that has come its slot.
    pub fn arrived(&mut self, key: NodeKey, low: f64, span: f64) -> Arrival {
        let held = &mut self.held;
        held.retry.came(key);
        let place = held.cut.find(key);
        if held.cut.node(place).key != key || !held.cut.lacks(place) {
            return Arrival::Unwanted;
        }
        let Some(slot) = held.slots.take() else { return Arrival::Unwanted };
        held.cut.set_brick(place, ResidentBrick { slot, low, span });
        held.revision += 1;
        Arrival::Slot(slot)
    }

    /// Notes that a brick could not be read: its family is not asked for until it is worth another try. Whether it is the
    /// brick's first failure.
    pub fn failed(&mut self, key: NodeKey, kind: BrickErrorKind) -> bool {
        self.held.retry.failed(key, kind, self.held.now_s)
    }

    /// Bricks that are expected, and those that the motion since an earlier frame, of which this is the rule and the time, will
    /// ask for, if it goes on, of the leaves that rays meet.
    fn ahead(
        &self,
        moment: &Moment,
        leaves: impl IntoIterator<Item = NodeKey>,
        before: Option<(LodRule, f64)>,
    ) -> Vec<NodeKey> {
        let rules = &moment.rules;
        let lacks = |key: NodeKey| {
            let node = self.held.cut.node(self.held.cut.find(key));
            let is_resident = node.key == key && node.brick.is_some();
            !is_resident && self.held.may_ask(key) && is_shown(rules.optics, (moment.summary)(key))
        };
        let expected = self.expected.nodes().filter(|&key| rules.shape.contains(key) && lacks(key));
        let mut ahead: Vec<NodeKey> = expected.take(MOST_AHEAD).collect();
        if let Some((before, then_s)) = before.filter(|&(_, then_s)| then_s < moment.now_s) {
            let between = Duration::try_from_secs_f64(moment.now_s - then_s).unwrap_or(Duration::MAX);
            let motion = Motion { now: rules.lod, before: &before, between };
            ahead.extend(prefetch(leaves, &motion, HORIZON, rules.shape, lacks, MOST_AHEAD - ahead.len()));
        }
        ahead
    }

    /// Moves what rays meet on to the present, `fade_s` being the time of a whole fade.
    pub(super) fn show(&mut self, moment: &Moment) {
        let held = &mut self.held;
        let order: Vec<u32> = held.cut.walk().collect();
        let step = match self.last_s {
            _ if moment.fade_s <= 0.0 => 1.0,
            None => 0.0,
            Some(last) => ((moment.now_s - last) / moment.fade_s).clamp(0.0, 1.0) as f32,
        };
        self.last_s = Some(moment.now_s);
        let tick = Tick { now_s: held.now_s, step, memory: held.memory() };
        let (retry, now_s) = (&held.retry, held.now_s);
        let is_lost = |key| !retry.may_ask_below(key, now_s);
        let shown = advance(&mut held.cut, moment.rules.shape, &order, &tick, is_lost);
        held.revision += u64::from(shown.has_changed);
        self.moving = shown.moving;
    }

    /// Shows at once what the rule of detail asks for.
    fn settle(&mut self, moment: &Moment) {
        let held = &mut self.held;
        // What has just come has not met the rule yet.
        let order: Vec<u32> = held.cut.walk().collect();
        refresh_deficits(&mut held.cut, &moment.rules, &order);
        held.revision += u64::from(settle(&mut held.cut));
        (self.last_s, self.moving) = (Some(moment.now_s), 0);
    }

    /// Whether the detail below a node is known to be out of reach now.
    pub fn is_lost(&self, key: NodeKey) -> bool {
        self.held.is_lost(key)
    }

    /// Whether any brick could not be read when it was last asked for.
    pub fn has_failures(&self) -> bool {
        self.held.retry.count() > 0
    }

    /// Whether leaves have to blend even where the display resolves the same everywhere: some fade, or rays meet what is
    /// too coarse beside what has come or found room.
    pub fn blends(&self) -> bool {
        let is_short = |place: u32| {
            let node = self.held.cut.node(place);
            node.is_visible && node.deficit > 0.0 && node.permits < 1.0
        };
        self.moving > 0 || self.held.cut.shown_leaves().any(is_short)
    }

    /// Leaves that no ray meets and that are too coarse for finer ones beside them, which rays meet and which blend down
    /// to them.
    pub fn short_beside(&self) -> usize {
        let cut = &self.held.cut;
        let is_short = |&place: &u32| {
            let node = cut.node(place);
            node.beside == Beside::Finer && node.deficit > 0.0 && !self.held.is_lost(node.key)
        };
        cut.shown_leaves().filter(is_short).count()
    }

    /// Bricks that slots are kept for.
    pub fn reserved(&self) -> usize {
        self.held.reserved()
    }

    /// Gives up families that are on their way and that nobody wants any more, fine ones first.
    fn drop_unwanted(&mut self, moment: &Moment, order: &[u32]) {
        let memory = self.held.memory();
        for &place in order.iter().rev() {
            let node = self.held.cut.node(place);
            let Some(first) = node.first_child else { continue };
            let lacks = (first..first + 8).any(|child| self.held.cut.lacks(child));
            let is_near = node.beside == Beside::Finer || memory.has_met(node);
            let is_wanted = node.deficit > 0.0 && is_near && !self.held.is_lost(node.key);
            let is_leaving = node.is_leaving && node.family == Family::Hidden;
            if ((lacks && !is_wanted) || is_leaving) && self.held.cut.may_collapse(moment.rules.shape, place)
            {
                self.held.collapse(place);
            }
        }
    }

    /// What a place adds to priorities: of a leaf that rays met, its deficit; of one beside it, so much that its family is
    /// as urgent as it was to have it.
    fn needed(&self, place: u32) -> Option<f64> {
        let node = self.held.cut.node(place);
        let of_beside = || (node.beside != Beside::Nothing).then_some(beside::URGENCY - 1.0);
        if self.held.is_met(place) { Some(node.deficit) } else { of_beside() }
    }

    /// Splits all that rays found too coarse, as far as there is room.
    fn split_all(&mut self, moment: &Moment, order: &[u32], priority: &[f64]) {
        let is_candidate = |&place: &u32| self.is_candidate(place);
        let mut candidates: Vec<Wish> = order
            .iter()
            .copied()
            .filter(is_candidate)
            .map(|place| self.wish_to_split(place, priority[place as usize]))
            .collect();
        candidates.sort_by(Wish::most_needed_first);
        let mut room = Room::new(&self.held, moment, priority);
        room.pay_debts(&mut self.held);
        for Wish { urgency, key, place, .. } in candidates {
            // Another may have needed it split, or needed its room.
            if self.held.cut.find(key) != place || self.held.cut.node(place).first_child.is_some() {
                continue;
            }
            for split in room.make(&mut self.held, place, urgency) {
                self.split(moment, split);
                self.held.urgency.insert(self.held.cut.node(split).key, urgency);
            }
            if room.is_exhausted() {
                break;
            }
        }
    }

    fn is_candidate(&self, place: u32) -> bool {
        let node: &CutNode = self.held.cut.node(place);
        node.first_child.is_none()
            && node.is_visible
            && node.brick.is_some()
            && node.deficit > 0.0
            && self.held.is_near_rays(place)
            && !self.held.is_lost(node.key)
    }

    fn wish_to_split(&self, place: u32, priority: f64) -> Wish {
        if self.held.is_met(place) {
            return self.wish(place, priority, self.held.cut.node(place).met.rays);
        }
        self.wish(place, beside::URGENCY, 0)
    }

    fn split(&mut self, moment: &Moment, place: u32) {
        let rules = &moment.rules;
        let contains = |key| rules.shape.contains(key).then(|| (moment.summary)(key));
        let first = self.held.cut.split(place, contains);
        let family: Vec<u32> = (first..first + 8).collect();
        refresh(&mut self.held.cut, rules, &family);
        self.splits += 1;
        self.held.revision += 1;
    }

    /// Visible nodes without a brick, most urgent families first.
    fn missing(&self, priority: &[f64]) -> Vec<NodeKey> {
        let mut missing = Vec::new();
        for place in self.held.cut.walk().filter(|&place| self.held.awaits(place)) {
            let (urgency, rays) = match self.held.cut.node(place).parent {
                None => (f64::INFINITY, 0),
                Some(parent) => {
                    let above = self.held.cut.node(parent);
                    let split = self.held.urgency.get(&above.key).copied().unwrap_or(f64::NEG_INFINITY);
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
        Wish { urgency, rays, key: self.held.cut.node(place).key, place }
    }
}
