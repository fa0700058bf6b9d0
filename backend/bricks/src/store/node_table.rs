//! The place of a node in the table: the nodes of all depths in [`NodeKey`] order.

use crate::{NodeKey, OctreeShape};

/// First place of each depth.
#[derive(Clone, Debug)]
pub(super) struct NodeTable {
    shape: OctreeShape,
    first: Vec<u64>,
    nodes: u64,
}

impl NodeTable {
    /// None if the octree has more nodes than can be counted.
    pub fn new(shape: OctreeShape) -> Option<Self> {
        let mut first = Vec::new();
        let mut nodes = 0u64;
        for depth in 0..=shape.finest_depth() {
            first.push(nodes);
            let bricks = shape.level_bricks(depth).to_array().map(u64::from);
            let count = bricks[0].checked_mul(bricks[1])?.checked_mul(bricks[2])?;
            nodes = nodes.checked_add(count)?;
        }
        Some(Self { shape, first, nodes })
    }

    /// Nodes of all depths.
    pub fn nodes(&self) -> u64 {
        self.nodes
    }

    /// Place of a node that the octree contains.
    pub fn place(&self, node: NodeKey) -> u64 {
        let bricks = self.shape.level_bricks(node.depth);
        let (x, y, z) = (u64::from(node.cell.x), u64::from(node.cell.y), u64::from(node.cell.z));
        self.first[usize::from(node.depth)] + (z * u64::from(bricks.y) + y) * u64::from(bricks.x) + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec3;

    #[test]
    fn places_follow_the_order_of_keys() {
        let shape = OctreeShape::new(UVec3::new(100, 57, 29));
        let table = NodeTable::new(shape).unwrap();
        let keys: Vec<_> = (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth)).collect();
        assert!(keys.is_sorted());
        assert!(keys.iter().enumerate().all(|(place, &key)| table.place(key) == place as u64));
        assert_eq!(table.nodes(), keys.len() as u64);
    }
}
