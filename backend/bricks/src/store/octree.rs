//! The octree's geometry: which nodes there are and where they lie.

use crate::OWN_EDGE;
use glam::{DVec3, UVec3};
use serde::{Deserialize, Serialize};

/// A node: its depth (0 = root) and its cell among the 2^depth cells along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct NodeKey {
    /// Depth, 0 = root.
    pub depth: u8,
    /// Cell along x, y, z.
    pub cell: UVec3,
}

impl NodeKey {
    /// The root.
    pub const ROOT: Self = Self { depth: 0, cell: UVec3::ZERO };

    /// Child `octant` (bit 0 = x, bit 1 = y, bit 2 = z).
    pub fn child(self, octant: u32) -> Self {
        let offset = UVec3::new(octant & 1, (octant >> 1) & 1, octant >> 2);
        Self { depth: self.depth + 1, cell: self.cell * 2 + offset }
    }

    /// The parent; None at the root.
    pub fn parent(self) -> Option<Self> {
        (self.depth > 0).then(|| Self { depth: self.depth - 1, cell: self.cell / 2 })
    }
}

impl std::fmt::Display for NodeKey {
    /// `depth/x,y,z`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{},{},{}", self.depth, self.cell.x, self.cell.y, self.cell.z)
    }
}

impl Ord for NodeKey {
    /// By depth, then z, y, x: the order of the node table in a store.
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let rank = |key: &Self| (key.depth, key.cell.z, key.cell.y, key.cell.x);
        rank(self).cmp(&rank(other))
    }
}

impl PartialOrd for NodeKey {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Size and depth of a volume's octree. Level l (0 = finest) has voxels of edge 2^l in units of the finest voxel,
/// sample centres at (i + 0.5) · 2^l; depth d holds level `finest_depth - d`. A node's own region has an edge of
/// 28 voxels of its level; the part beyond the volume's extent holds nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OctreeShape {
    dims: UVec3,
    finest_depth: u8,
}

impl OctreeShape {
    /// The octree of a volume of `dims` voxels, each at least 1.
    pub fn new(dims: UVec3) -> Self {
        assert!(dims.min_element() >= 1, "a volume has at least one voxel along each axis");
        let bricks = dims.max_element().div_ceil(OWN_EDGE as u32);
        let finest_depth = bricks.next_power_of_two().trailing_zeros() as u8;
        Self { dims, finest_depth }
    }

    /// Voxels of the finest level along each axis.
    pub fn dims(&self) -> UVec3 {
        self.dims
    }

    /// Depth of the finest level.
    pub fn finest_depth(&self) -> u8 {
        self.finest_depth
    }

    /// Level of a depth: 0 = finest.
    pub fn level(&self, depth: u8) -> u8 {
        self.finest_depth - depth
    }

    /// Voxels of the level at `depth` along each axis.
    pub fn level_dims(&self, depth: u8) -> UVec3 {
        let edge = 1u32 << self.level(depth);
        UVec3::from_array(self.dims.to_array().map(|n| n.div_ceil(edge)))
    }

    /// Bricks of the level at `depth` along each axis: the cells that hold something of the volume.
    pub fn level_bricks(&self, depth: u8) -> UVec3 {
        UVec3::from_array(self.level_dims(depth).to_array().map(|n| n.div_ceil(OWN_EDGE as u32)))
    }

    /// Whether the node's region holds any of the volume.
    pub fn contains(&self, node: NodeKey) -> bool {
        node.depth <= self.finest_depth && node.cell.cmplt(self.level_bricks(node.depth)).all()
    }

    /// The node's region in the volume frame (units of the finest voxel), cut off at the volume's extent.
    pub fn region(&self, node: NodeKey) -> (DVec3, DVec3) {
        let edge = (OWN_EDGE as f64) * f64::from(1u32 << self.level(node.depth));
        let low = node.cell.as_dvec3() * edge;
        (low, (low + edge).min(self.dims.as_dvec3()))
    }

    /// The corners of that region, x + 2 y + 4 z.
    pub fn corners(&self, node: NodeKey) -> [DVec3; 8] {
        let (low, high) = self.region(node);
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Nodes of a depth.
    pub fn node_count(&self, depth: u8) -> u64 {
        self.level_bricks(depth).as_u64vec3().element_product()
    }

    /// Nodes of all depths.
    pub fn total_node_count(&self) -> u64 {
        (0..=self.finest_depth()).map(|depth| self.node_count(depth)).sum()
    }

    /// A node of a depth by its number, x fastest.
    pub fn node(&self, depth: u8, number: u64) -> NodeKey {
        let across = self.level_bricks(depth).as_u64vec3();
        let row = number / across.x;
        let cell = [number % across.x, row % across.y, row / across.y].map(|i| i as u32);
        NodeKey { depth, cell: cell.into() }
    }

    /// All nodes of a depth, in the order of their numbers.
    pub fn nodes(&self, depth: u8) -> impl Iterator<Item = NodeKey> {
        (0..self.node_count(depth)).map(move |number| self.node(depth, number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_voxel_is_one_brick() {
        let shape = OctreeShape::new(UVec3::ONE);
        assert_eq!(shape.finest_depth(), 0);
        assert_eq!(shape.region(NodeKey::ROOT), (DVec3::ZERO, DVec3::ONE));
    }

    #[test]
    fn sizes_not_divisible_by_28_end_at_the_volume() {
        let shape = OctreeShape::new(UVec3::new(57, 28, 1));
        assert_eq!(shape.finest_depth(), 2);
        assert_eq!(shape.level_bricks(2), UVec3::new(3, 1, 1));
        let last = NodeKey { depth: 2, cell: UVec3::new(2, 0, 0) };
        assert!(shape.contains(last));
        assert_eq!(shape.region(last), (DVec3::new(56.0, 0.0, 0.0), DVec3::new(57.0, 28.0, 1.0)));
        assert_eq!(last.parent().and_then(NodeKey::parent), Some(NodeKey::ROOT));
        assert_eq!(shape.nodes(2).last(), Some(last));
    }
}
