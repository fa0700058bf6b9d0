//! Which nodes rays meet, and how much of them: detail appears and goes in time, and never beside a border it would show.
//!
//! What is resident and what is shown are two things. The cut is what is resident. A family of it is shown if its parent
//! is too coarse for the display; every node has its share t of the blend with its parent, which rises or falls over
//! time. So a family that is no longer needed fades away and stays in the cache until others need the room.

use super::{Cut, CutNode, Family, IndexRules};
use bricks::{NodeKey, OctreeShape};

/// Since when nodes count as seen.
#[derive(Clone, Copy, Debug)]
pub struct Memory {
    /// Those that rays met since then, seconds.
    pub met_since_s: f64,
    /// Those that began to show since then: rays have had no time to report them.
    pub new_since_s: f64,
}

impl Memory {
    /// Whether rays met a node.
    pub fn has_met(&self, node: &CutNode) -> bool {
        node.met.time_s >= self.met_since_s
    }

    /// Whether somebody may see it.
    pub fn may_see(&self, node: &CutNode) -> bool {
        self.has_met(node) || node.met.since_s >= self.new_since_s
    }
}

/// A moment on the working set's clock.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// Now, seconds.
    pub now_s: f64,
    /// By how much shares may change until now, 0 to 1.
    pub step: f32,
    /// Which nodes count as seen.
    pub memory: Memory,
}

/// Brings visibility and deficits of all nodes up to date with the frame.
pub fn refresh(cut: &mut Cut, rules: &IndexRules, order: &[u32]) {
    for &place in order {
        let is_visible = !rules.is_empty(cut.node(place));
        cut.node_mut(place).is_visible = is_visible;
    }
    refresh_deficits(cut, rules, order);
}

/// The same where the transfer functions are those of the frame before.
pub(super) fn refresh_deficits(cut: &mut Cut, rules: &IndexRules, order: &[u32]) {
    let rule = rules.lod.measured();
    for &place in order {
        let deficit = rules.deficit_by(&rule, cut.node(place));
        cut.node_mut(place).deficit = deficit;
    }
}

/// Shows at once what the rule of detail asks for, as far as it is resident. The outcome depends on nothing else: not on
/// what rays met, nor on what was shown before. Families that are about to go, to make room, are no longer shown. Whether
/// that is anything new.
pub fn settle(cut: &mut Cut) -> bool {
    let mut has_changed = false;
    for place in cut.walk().collect::<Vec<_>>() {
        let before = cut.appearance(place);
        let is_shown = cut.wants_children(place);
        let node = cut.node_mut(place);
        node.family = if is_shown { Family::Shown } else { Family::Hidden };
        // Complete frames weigh corners by the rule of detail: nothing blends down to what is short.
        node.permits = permitted(node.is_visible, node.deficit, true);
        if let Some(first) = node.first_child {
            (first..first + 8).for_each(|child| cut.node_mut(child).shown = f32::from(u8::from(is_shown)));
        }
        has_changed |= cut.appearance(place) != before;
    }
    has_changed
}

/// What became of what rays meet.
#[derive(Clone, Copy, Debug)]
pub struct Advanced {
    /// Leaves whose shares have not come to rest.
    pub moving: u64,
    /// Whether anything is shown otherwise than before.
    pub has_changed: bool,
}

/// Moves all shares toward what the rule of detail asks for. Families begin and
/// end one by one, each in sight of what the ones before it did; `order` has parents before children. `is_lost` tells
/// whether the detail below a node is out of reach.
pub fn advance(
    cut: &mut Cut,
    shape: &OctreeShape,
    order: &[u32],
    tick: &Tick,
    is_lost: impl Fn(NodeKey) -> bool,
) -> Advanced {
    let mut has_changed = false;
    for &place in order {
        let before = cut.appearance(place);
        let wants = cut.wants_children(place);
        let node = cut.node(place);
        let is_seen = tick.memory.may_see(node);
        let is_ready = node.permits == 0.0;
        let family = match node.family {
            Family::Hidden if wants && is_ready && cut.may_show(shape, place) => {
                cut.begin_family(place, is_seen, tick.now_s);
                Family::Shown
            }
            Family::Shown if !wants && cut.may_go(shape, place) => Family::Going,
            Family::Going if wants => Family::Shown,
            same => same,
        };
        cut.node_mut(place).family = family;
        cut.move_family(place, tick.step);
        let is_lost = is_lost(cut.node(place).key);
        let node = cut.node_mut(place);
        if node.shown_child().is_none() {
            let target = permitted(node.is_visible, node.deficit, is_lost);
            node.permits += (target - node.permits).clamp(-tick.step, tick.step);
        }
        has_changed |= cut.appearance(place) != before;
    }
    let is_moving = |place: &u32| {
        let node = cut.node(*place);
        let target = permitted(node.is_visible, node.deficit, is_lost(node.key));
        node.permits != target || node.shown < 1.0
    };
    Advanced { moving: cut.shown_leaves().filter(is_moving).count() as u64, has_changed }
}

/// How far a leaf lets finer neighbours show themselves in the end: not at all, met by rays or not, for what comes into
/// sight would show a border until its own detail is there. What shows nothing does so at every level, and has no borders;
/// where detail is lost, a picture at rest is the one that complete frames draw.
fn permitted(is_visible: bool, deficit: f64, is_lost: bool) -> f32 {
    if is_visible && (deficit <= 0.0 || !is_lost) { 0.0 } else { 1.0 }
}

impl Cut {
    /// How a node and its children are shown.
    fn appearance(&self, place: u32) -> (Family, f32, Option<f32>) {
        let node = self.node(place);
        (node.family, node.permits, node.first_child.map(|first| self.node(first).shown))
    }

    /// Whether a node's children are resident and wanted.
    fn wants_children(&self, place: u32) -> bool {
        let node = self.node(place);
        let is_wanted = node.is_visible && node.deficit > 0.0 && !node.is_leaving;
        is_wanted && node.first_child.is_some_and(|first| (first..first + 8).all(|child| !self.lacks(child)))
    }

    /// Whether a node shows something and its brick is not there.
    pub fn lacks(&self, place: u32) -> bool {
        let node = self.node(place);
        node.is_visible && node.brick.is_none()
    }

    /// Children begin as their parent, with no share of their own.
    fn begin_family(&mut self, place: u32, is_seen: bool, now_s: f64) {
        let first = self.node(place).first_child.expect("only what has children can show them");
        for child in first..first + 8 {
            let child = self.node_mut(child);
            (child.shown, child.permits) = (0.0, 0.0);
            child.met.since_s = if is_seen { now_s } else { f64::NEG_INFINITY };
        }
    }

    fn move_family(&mut self, place: u32, step: f32) {
        let Some(first) = self.node(place).shown_child() else { return };
        let shown = self.node(first).shown;
        let moved = match self.node(place).family {
            Family::Going => (shown - step).max(0.0),
            Family::Shown | Family::Hidden => (shown + step).min(1.0),
        };
        (first..first + 8).for_each(|child| self.node_mut(child).shown = moved);
        if moved == 0.0 && self.node(place).family == Family::Going {
            self.inherit_meeting(place);
            let node = self.node_mut(place);
            (node.family, node.permits) = (Family::Hidden, 0.0);
        }
    }

    /// Passes to a node what its children know of rays: it takes their place.
    pub(super) fn inherit_meeting(&mut self, place: u32) {
        let first = self.node(place).first_child.expect("only what has children can take their place");
        let met = (first..first + 8).map(|child| self.node(child).met);
        let latest = met.max_by(|a, b| a.time_s.total_cmp(&b.time_s)).expect("there are eight");
        let node = self.node_mut(place);
        if latest.time_s > node.met.time_s {
            node.met = latest;
        }
    }
}
