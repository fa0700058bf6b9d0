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
    /// Share of the node's own samples at its eight corners, the parent's having the rest: unorm8 each, corner
    /// x + 2 y + 4 z in byte x + 2 y of word z. See [`pack_weights`].
    pub weights: [u32; 2],
    /// Standard deviation of code 255 of the node's deviations, normalised; 0 where its samples stand for themselves.
    pub deviation_scale: f32,
}

/// The weights of a node whose samples are all its own.
pub const FULL_WEIGHTS: [u32; 2] = [u32::MAX; 2];

/// The weights of corners x + 2 y + 4 z, each in [0, 1], as a record holds them; 0 and 1 are exact.
pub fn pack_weights(corners: [f32; 8]) -> [u32; 2] {
    let code = |weight: f32| (weight.clamp(0.0, 1.0) * 255.0).round() as u32;
    let word = |first: usize| (0..4).fold(0, |word, i| word | code(corners[first + i]) << (8 * i));
    [word(0), word(4)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_and_empty_weights_are_exact() {
        assert_eq!(pack_weights([1.0; 8]), FULL_WEIGHTS);
        assert_eq!(pack_weights([0.0; 8]), [0; 2]);
        assert_eq!(pack_weights([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), [0xff00, 0xff00_0000]);
    }
}
