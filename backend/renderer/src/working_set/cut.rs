//! The cut: the part of the octree that is resident, as families of eight in one arena.
//!
//! Pure: it knows no device, no file and no clock. A node's place in the arena is its place in the index that rays
//! traverse, so feedback speaks of nodes by these places; they hold until the node is collapsed.

use bricks::{NodeKey, NodeSummary};

/// A resident node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutNode {
    /// Which node.
    pub key: NodeKey,
    /// Bounds of its values; None if its region lies outside the volume.
    pub summary: Option<NodeSummary>,
    /// Place of the parent; None at the root.
    pub parent: Option<u32>,
    /// Place of the first of eight children; None for a leaf.
    pub first_child: Option<u32>,
    /// Slot of its brick in the cache, and the brick's data value of code 0 and per unit of the [0, 1] sample.
    pub brick: Option<ResidentBrick>,
    /// Whether the frame's transfer functions show any of its values.
    pub is_visible: bool,
    /// Levels it is too coarse by, as of the last frame; at most 0 if no finer level exists.
    pub deficit: f64,
    /// Its share of its own samples, its parent having the rest: t of the spatiotemporal blend.
    pub shown: f32,
    /// As a leaf: how far it lets finer neighbours show themselves at shared corners. 0 if they blend down to it, 1 if
    /// it shows nothing.
    pub permits: f32,
    /// What becomes of its children.
    pub family: Family,
    /// Whether its children are to go, to make room for others.
    pub is_leaving: bool,
    /// What rays reported of it.
    pub met: Meeting,
    /// Where it is a leaf that no ray meets: how it stands to what rays meet around it.
    pub beside: Beside,
}

/// How a leaf that no ray meets stands to those around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Beside {
    /// Rays meet none of them that is as fine, or they meet the leaf.
    #[default]
    Nothing,
    /// Rays meet one that is as fine, and none that blends down to it.
    AsFine,
    /// Rays meet one that is finer, and that blends down to it, as it shows something.
    Finer,
}

/// The eight children of a node, as rays meet them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Family {
    /// There are none, or rays do not meet them.
    #[default]
    Hidden,
    /// Rays meet them, and they appear.
    Shown,
    /// Rays meet them, and they go.
    Going,
}

/// When and how rays met a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// When a ray last sampled it, seconds; −∞ where none did.
    pub time_s: f64,
    /// When rays could first have met it, seconds.
    pub since_s: f64,
    /// Rays that did in that frame.
    pub rays: u32,
}

impl Meeting {
    /// No ray yet.
    pub const NEVER: Self = Self { time_s: f64::NEG_INFINITY, since_s: f64::NEG_INFINITY, rays: 0 };
}

/// A brick in the cache.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidentBrick {
    /// Which slot.
    pub slot: u32,
    /// Data value of the stored sample 0.
    pub low: f64,
    /// Data value of the stored sample 1, less `low`.
    pub span: f64,
}

/// The resident part of the octree. Place 0 is the root.
#[derive(Clone, Debug)]
pub struct Cut {
    nodes: Vec<CutNode>,
    free_families: Vec<u32>,
}

impl CutNode {
    fn leaf(key: NodeKey, summary: Option<NodeSummary>, parent: Option<u32>) -> Self {
        Self {
            key,
            summary,
            parent,
            first_child: None,
            brick: None,
            is_visible: false,
            deficit: 0.0,
            shown: 0.0,
            permits: 0.0,
            family: Family::Hidden,
            is_leaving: false,
            met: Meeting::NEVER,
            beside: Beside::Nothing,
        }
    }

    /// Whether it shows something, and as fine as the display resolves.
    pub fn is_fine_enough(&self) -> bool {
        self.is_visible && self.deficit <= 0.0
    }

    /// The first of its children, where rays meet them.
    pub fn shown_child(&self) -> Option<u32> {
        self.first_child.filter(|_| self.family != Family::Hidden)
    }
}

impl Cut {
    /// The root alone, without its brick.
    pub fn new(root: NodeSummary) -> Self {
        let root = CutNode { shown: 1.0, ..CutNode::leaf(NodeKey::ROOT, Some(root), None) };
        Self { nodes: vec![root], free_families: Vec::new() }
    }

    /// All places, those of collapsed families included: no link leads there.
    pub fn nodes(&self) -> &[CutNode] {
        &self.nodes
    }

    /// The node at a place.
    pub fn node(&self, place: u32) -> &CutNode {
        &self.nodes[place as usize]
    }

    /// The node at a place, to be changed.
    pub(super) fn node_mut(&mut self, place: u32) -> &mut CutNode {
        &mut self.nodes[place as usize]
    }

    /// Gives a node its brick.
    pub fn set_brick(&mut self, place: u32, brick: ResidentBrick) {
        self.nodes[place as usize].brick = Some(brick);
    }

    /// Makes a leaf an inner node with eight leaves, and yields the place of the first.
    pub fn split(&mut self, place: u32, summary: impl Fn(NodeKey) -> Option<NodeSummary>) -> u32 {
        let parent = *self.node(place);
        assert!(parent.first_child.is_none(), "only a leaf is split");
        let family: [CutNode; 8] = std::array::from_fn(|octant| {
            let key = parent.key.child(octant as u32);
            CutNode::leaf(key, summary(key), Some(place))
        });
        let first = match self.free_families.pop() {
            Some(first) => {
                self.nodes[first as usize..first as usize + 8].copy_from_slice(&family);
                first
            }
            None => {
                self.nodes.extend(family);
                (self.nodes.len() - 8) as u32
            }
        };
        let parent = &mut self.nodes[place as usize];
        (parent.first_child, parent.family, parent.is_leaving) = (Some(first), Family::Hidden, false);
        first
    }

    /// Drops the eight children of a node, which must be leaves; yields the slots of their bricks.
    pub fn collapse(&mut self, place: u32) -> Vec<u32> {
        let first = self.nodes[place as usize].first_child.take().expect("only an inner node is collapsed");
        self.nodes[place as usize].family = Family::Hidden;
        self.free_families.push(first);
        let children = &mut self.nodes[first as usize..first as usize + 8];
        children.iter_mut().filter_map(|child| child.brick.take().map(|brick| brick.slot)).collect()
    }

    /// The places of all live nodes, parents before children.
    pub fn walk(&self) -> impl Iterator<Item = u32> + '_ {
        self.walk_by(|node| node.first_child)
    }

    /// The places of all nodes that rays meet, and of those above them, parents before children.
    pub fn walk_shown(&self) -> impl Iterator<Item = u32> + '_ {
        self.walk_by(CutNode::shown_child)
    }

    /// The places of the nodes that rays meet.
    pub fn shown_leaves(&self) -> impl Iterator<Item = u32> + '_ {
        self.walk_shown().filter(|&place| self.node(place).shown_child().is_none())
    }

    fn walk_by(&self, first_child: impl Fn(&CutNode) -> Option<u32>) -> impl Iterator<Item = u32> {
        let mut queue = std::collections::VecDeque::from([0u32]);
        std::iter::from_fn(move || {
            let place = queue.pop_front()?;
            if let Some(first) = first_child(self.node(place)) {
                queue.extend(first..first + 8);
            }
            Some(place)
        })
    }

    /// The node at the key's depth, or the leaf above it.
    pub fn find(&self, key: NodeKey) -> u32 {
        self.find_by(key, |node| node.first_child)
    }

    /// The same among the nodes that rays meet.
    pub fn find_shown(&self, key: NodeKey) -> u32 {
        self.find_by(key, CutNode::shown_child)
    }

    fn find_by(&self, key: NodeKey, first_child: impl Fn(&CutNode) -> Option<u32>) -> u32 {
        let mut at = 0;
        for depth in 1..=key.depth {
            let Some(first) = first_child(self.node(at)) else { break };
            let bits = (key.cell >> glam::UVec3::splat(u32::from(key.depth - depth))) & glam::UVec3::ONE;
            at = first + (bits.x | bits.y << 1 | bits.z << 2);
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANY: NodeSummary = NodeSummary { min: 0.0, max: 1.0 };

    fn brick(slot: u32) -> ResidentBrick {
        ResidentBrick { slot, low: 0.0, span: 1.0 }
    }

    #[test]
    fn a_collapse_gives_back_slots_and_places() {
        let mut cut = Cut::new(ANY);
        let first = cut.split(0, |_| Some(ANY));
        cut.set_brick(first + 3, brick(7));
        assert_eq!(cut.walk().count(), 9);
        assert_eq!(cut.collapse(0), vec![7]);
        assert_eq!(cut.walk().count(), 1);
        assert_eq!(cut.split(0, |_| Some(ANY)), first);
        assert_eq!(cut.nodes().len(), 9);
        assert_eq!(cut.node(first + 3).brick, None);
    }
}
