//! Room in the cache for what is more needed than what is there.

use super::holdings::Holdings;
use super::{Beside, CutNode, Family, Moment, neighbours};
use bricks::NodeKey;
use std::collections::{BTreeMap, HashSet};

/// How many levels less needed a visible family must be than the one that takes its room. Without this margin, two that
/// are equally needed would swap places for ever.
const MARGIN: f64 = 0.25;

/// How needed a family is: priority, when it was last met, rays, key. Nothing in it is NaN.
type Rank = (Ordered, Ordered, u32, NodeKey);

/// A number that is not NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// How many nodes may wait for room at a time: more would only fade what may be wanted again.
const MOST_WAITING: usize = 16;

/// The room that is left in one update.
pub(super) struct Room<'a> {
    moment: &'a Moment<'a>,
    priority: &'a [f64],
    /// Slots that are neither used nor kept for a brick on its way.
    free: i64,
    /// Bricks that may still be asked for.
    in_flight: i64,
    /// Slots of families that are fading away.
    coming: i64,
    /// Slots that nodes wait for which found no room.
    owed: i64,
    /// Nodes that found no room.
    waiting: usize,
    /// Families whose children are all leaves, least needed first; made when it is first needed.
    victims: Option<BTreeMap<Rank, u32>>,
}

impl<'a> Room<'a> {
    pub(super) fn new(set: &Holdings, moment: &'a Moment<'a>, priority: &'a [f64]) -> Self {
        let reserved = set.reserved() as i64;
        let mut room = Self {
            moment,
            priority,
            free: set.slots.free() as i64 - reserved,
            in_flight: moment.most_in_flight as i64 - reserved,
            coming: 0,
            owed: 0,
            waiting: 0,
            victims: None,
        };
        let leaving = set.cut.walk().filter(|&place| set.cut.node(place).is_leaving);
        room.coming = leaving.map(|place| room.bricks_of(set, place)).sum();
        room
    }

    /// Whether it is of no use to ask for more.
    pub(super) fn is_exhausted(&self) -> bool {
        self.waiting >= MOST_WAITING || self.in_flight <= 0
    }

    /// Gives up what is least needed where more bricks are due than there are slots: nodes that were empty may have
    /// become visible.
    pub(super) fn pay_debts(&mut self, set: &mut Holdings) {
        if self.free < 0 {
            self.give_up(set, f64::INFINITY, &HashSet::new());
        }
    }

    /// The splits that splitting `place` takes, itself last, when there is room for all their bricks, which is then taken.
    /// Gives up what is less needed where that helps. Empty where there is no room now.
    pub(super) fn make(&mut self, set: &mut Holdings, place: u32, urgency: f64) -> Vec<u32> {
        let splits = set.cut.splits_for(self.moment.rules.shape, place);
        let needed: i64 = splits.iter().map(|&split| self.bricks_below(set, split)).sum();
        // One family may always be on its way, however small the limit is.
        let is_first = self.in_flight >= self.moment.most_in_flight as i64;
        if needed > self.in_flight && !is_first {
            self.in_flight = 0;
            return Vec::new();
        }
        self.owed += needed;
        let kept = self.kept(set, &splits);
        if self.owed > self.free {
            self.give_up(set, urgency, &kept);
        }
        // Whatever waits is served before those that need room less.
        if self.owed > self.free || self.waiting > 0 {
            self.waiting += 1;
            return Vec::new();
        }
        self.owed -= needed;
        self.free -= needed;
        self.in_flight -= needed;
        self.keep(set, &kept);
        splits
    }

    /// Bricks that a leaf's children would take.
    fn bricks_below(&self, set: &Holdings, place: u32) -> i64 {
        let key = set.cut.node(place).key;
        if set.is_lost(key) {
            return 0;
        }
        let rules = &self.moment.rules;
        let shows = |child: &NodeKey| {
            rules.shape.contains(*child) && bricks::is_shown(rules.optics, (self.moment.summary)(*child))
        };
        (0..8).map(|octant| key.child(octant)).filter(shows).count() as i64
    }

    /// The families that must stay so that these splits leave touching nodes within one level.
    fn kept(&self, set: &Holdings, splits: &[u32]) -> HashSet<u32> {
        let mut kept = HashSet::new();
        for &split in splits {
            let key = set.cut.node(split).key;
            let around = neighbours(self.moment.rules.shape, key).map(|cell| set.cut.find(cell));
            kept.extend(around.chain([split]).filter_map(|place| set.cut.node(place).parent));
        }
        kept
    }

    /// Families that splits rest on stay, were they about to go: they could not while what is split lasts, and the room that
    /// they were to make would be waited for in vain.
    fn keep(&mut self, set: &mut Holdings, kept: &HashSet<u32>) {
        for &place in kept {
            if std::mem::take(&mut set.cut.node_mut(place).is_leaving) {
                self.coming -= self.bricks_of(set, place);
            }
        }
    }

    /// Gives up families that are less needed, until all that is owed is free: at once where nobody sees them; others
    /// begin to fade, and make room in a later frame.
    fn give_up(&mut self, set: &mut Holdings, urgency: f64, kept: &HashSet<u32>) {
        let mut victims = self.victims.take().unwrap_or_else(|| self.all_victims(set));
        let mut passed = BTreeMap::new();
        while self.owed > self.free + self.coming {
            let Some((rank, place)) = victims.pop_first() else { break };
            if !is_less_needed(rank.0.0, urgency) {
                victims.insert(rank, place);
                break;
            }
            if kept.contains(&place) || !set.cut.may_collapse(self.moment.rules.shape, place) {
                passed.insert(rank, place);
                continue;
            }
            let bricks = self.bricks_of(set, place);
            if self.is_seen(set, place) {
                self.coming += bricks;
                set.cut.node_mut(place).is_leaving = true;
                continue;
            }
            self.free += bricks;
            let parent = set.cut.node(place).parent;
            let was_shown = set.cut.node(place).family != Family::Hidden;
            set.collapse(place);
            let node = set.cut.node_mut(place);
            if was_shown && node.is_visible {
                // Nobody sees what blends down to it.
                node.permits = 0.0;
            }
            if let Some(parent) = parent.filter(|&parent| self.is_victim(set, parent)) {
                victims.insert(self.rank(set, parent), parent);
            }
        }
        victims.append(&mut passed);
        self.victims = Some(victims);
    }

    /// Whether anybody would see a family go, or what blends down to it in its place.
    fn is_seen(&self, set: &Holdings, place: u32) -> bool {
        let node = set.cut.node(place);
        let Some(first) = node.first_child.filter(|_| node.family != Family::Hidden) else { return false };
        let memory = set.memory();
        let shows = |child: &CutNode| memory.may_see(child) || child.beside != Beside::Nothing;
        (first..first + 8).any(|child| shows(set.cut.node(child)))
    }

    /// Slots that a family holds or has reserved.
    fn bricks_of(&self, set: &Holdings, place: u32) -> i64 {
        let Some(first) = set.cut.node(place).first_child else { return 0 };
        let holds = |&child: &u32| set.cut.node(child).brick.is_some() || set.awaits(child);
        (first..first + 8).filter(holds).count() as i64
    }

    fn all_victims(&self, set: &Holdings) -> BTreeMap<Rank, u32> {
        let families = set.cut.walk().filter(|&place| self.is_victim(set, place));
        families.map(|place| (self.rank(set, place), place)).collect()
    }

    fn is_victim(&self, set: &Holdings, place: u32) -> bool {
        let node = set.cut.node(place);
        let is_leaf = |child| set.cut.node(child).first_child.is_none();
        let is_lowest = node.first_child.is_some_and(|first| (first..first + 8).all(is_leaf));
        is_lowest && !node.is_leaving
    }

    fn rank(&self, set: &Holdings, place: u32) -> Rank {
        let node = set.cut.node(place);
        // Families of this very update have no priority yet: they are as needed as the leaf that they were split from.
        let priority = self.priority.get(place as usize).copied().unwrap_or(f64::INFINITY);
        // Detail may hide behind what it was too coarse to hide behind before. Were it given up for that, it would be seen
        // again, and wanted again.
        let was_met = if set.has_met(place) { node.deficit } else { f64::NEG_INFINITY };
        let priority = priority.max(was_met);
        (Ordered(priority), Ordered(node.met.time_s), node.met.rays, node.key)
    }
}

/// What nobody sees makes room for what rays find too coarse. What lies beside what rays meet has a priority and an urgency
/// of 0: it makes room for that, too, and takes it from what is farther off alone.
fn is_less_needed(priority: f64, urgency: f64) -> bool {
    (priority <= 0.0 && urgency > 0.0) || priority + MARGIN < urgency
}
