//! Which cells touch which: the 26 neighbours, and those of the children.

use super::{Cut, Family};
use bricks::{NodeKey, OctreeShape};
use glam::{IVec3, UVec3};

/// The cells at the node's depth that touch it and hold something of the volume: at most 26.
pub fn neighbours(shape: &OctreeShape, key: NodeKey) -> impl Iterator<Item = NodeKey> {
    around(shape, key.depth, key.cell.as_ivec3() - 1, key.cell.as_ivec3() + 1)
        .filter(move |&other| other.cell != key.cell)
}

/// The cells one level below the node that touch it from outside or inside: at most 64.
fn fine_cells(shape: &OctreeShape, key: NodeKey) -> impl Iterator<Item = NodeKey> {
    let low = key.cell.as_ivec3() * 2;
    around(shape, key.depth + 1, low - 1, low + 2)
}

fn around(shape: &OctreeShape, depth: u8, low: IVec3, high: IVec3) -> impl Iterator<Item = NodeKey> {
    let bricks = shape.level_bricks(depth).as_ivec3();
    let (low, high) = (low.max(IVec3::ZERO), high.min(bricks - 1));
    (low.z..=high.z).flat_map(move |z| {
        (low.y..=high.y).flat_map(move |y| {
            (low.x..=high.x).map(move |x| NodeKey { depth, cell: UVec3::new(x as u32, y as u32, z as u32) })
        })
    })
}

impl Cut {
    /// The leaves that must be split so that `leaf` can be, coarse ones first, itself last: touching leaves differ by one
    /// level at most.
    pub fn splits_for(&self, shape: &OctreeShape, leaf: u32) -> Vec<u32> {
        let mut found = Vec::new();
        self.add_splits_for(shape, leaf, &mut found);
        found
    }

    fn add_splits_for(&self, shape: &OctreeShape, leaf: u32, found: &mut Vec<u32>) {
        let key = self.node(leaf).key;
        for neighbour in neighbours(shape, key) {
            let place = self.find(neighbour);
            if self.node(place).key.depth < key.depth && !found.contains(&place) {
                self.add_splits_for(shape, place, found);
            }
        }
        found.push(leaf);
    }

    /// Whether a node may become a leaf: its children are leaves, and no leaf that touches it is finer than they are.
    pub fn may_collapse(&self, shape: &OctreeShape, place: u32) -> bool {
        let key = self.node(place).key;
        fine_cells(shape, key).all(|cell| {
            let touching = self.node(self.find(cell));
            touching.key.depth <= key.depth || touching.first_child.is_none()
        })
    }

    /// The same among the nodes that rays meet: whether a shown family may begin to go.
    pub(super) fn may_go(&self, shape: &OctreeShape, place: u32) -> bool {
        let key = self.node(place).key;
        fine_cells(shape, key).all(|cell| {
            let touching = self.node(self.find_shown(cell));
            touching.key.depth <= key.depth || touching.shown_child().is_none()
        })
    }

    /// Whether a family may begin to show: its parent is fully shown up to its corners, that is, everything around is as
    /// fine as the parent and stays so, or lets finer neighbours show themselves.
    pub(super) fn may_show(&self, shape: &OctreeShape, place: u32) -> bool {
        let node = self.node(place);
        let is_settled = |at: u32| {
            let other = self.node(at);
            let stays = other.parent.is_none_or(|parent| self.node(parent).family == Family::Shown);
            let is_as_fine = other.key.depth == node.key.depth;
            if is_as_fine {
                other.shown == 1.0 && stays
            } else {
                other.permits == 1.0 && !other.is_fine_enough()
            }
        };
        is_settled(place) && neighbours(shape, node.key).all(|key| is_settled(self.find_shown(key)))
    }
}
