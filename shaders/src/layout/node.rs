//! A node of the spatial index.

use bytemuck::{Pod, Zeroable};

/// Stands for "no node": no parent, no children, no neighbour.
pub const NO_NODE: u32 = u32::MAX;
/// Stands for "no brick": nothing of the node is visible.
pub const NO_SLOT: u32 = u32::MAX;

/// One node as the traversal sees it. 80 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct NodeRecord {
    /// Cell among the 2^depth cells along each axis.
    pub cell: [u32; 3],
    /// Depth, 0 = root.
    pub depth: u32,
    /// Index of the parent, or [`NO_NODE`].
    pub parent: u32,
    /// Index of the first of eight children in a row, or [`NO_NODE`] for a leaf of the cut.
    pub first_child: u32,
    /// Slot of the node's brick in the atlas, or [`NO_SLOT`] where the node is empty.
    pub slot: u32,
    /// Levels the node is too coarse by; above 0 only where a finer level exists.
    pub deficit: f32,
    /// Normalised scalar of code 0.
    pub offset: f32,
    /// Normalised scalar per unit of the stored [0, 1] sample.
    pub scale: f32,
    /// The node beyond each face (−x, +x, −y, +y, −z, +z) at this depth or coarser, or [`NO_NODE`].
    pub neighbours: [u32; 6],
    /// The largest extinction that any of the node's values has, in units of the table; beyond all bounds where steps
    /// may not be longer than the shortest.
    pub most_extinction: f32,
    /// Fills the struct to a multiple of 16 bytes.
    pub padding: [u32; 3],
}
