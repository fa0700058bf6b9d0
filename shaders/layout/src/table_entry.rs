//! Entries of pre-integrated transfer functions.

use bytemuck::{Pod, Zeroable};

/// A cell of the scalars, by which nodes of tables are found.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TableCell {
    /// The node at its lower border. Nodes between that and the next cell's are knots of transfer functions.
    pub first: u32,
    /// How many cells below it change a picture: so cells a to b together change nothing if those of a and b + 1 are equal.
    pub occupied: u32,
    /// Where the first nodes inside it are, in table cells; `f32::MAX` where there are fewer.
    pub inside: [f32; TableCell::LISTED],
}

impl TableCell {
    /// Nodes inside a cell that it lists: kernels find these without a search.
    pub const LISTED: usize = 2;
}

/// f and F = ∫ f of four functions at one node of a table: (k red, k green, k blue, τ), or the factors of a material.
/// F is the sum of two f32, so that the difference of two integrals keeps its digits where a spike stands beside an
/// almost empty range. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TableEntry {
    /// f at the node.
    pub value: [f32; 4],
    /// F at the node, rounded to f32; in units of table cells.
    pub integral: [f32; 4],
    /// What the rounding left of F.
    pub integral_rest: [f32; 4],
    /// Where the node is, in table cells.
    pub position: f32,
    /// Fills the struct to 64 bytes.
    pub padding: [f32; 3],
}

/// The same for the importance alone, at the same nodes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ImportanceEntry {
    /// ι at the node.
    pub value: f32,
    /// ∫ ι, rounded to f32; in units of table cells.
    pub integral: f32,
    /// What the rounding left of it.
    pub integral_rest: f32,
    /// Fills the struct to 16 bytes.
    pub padding: f32,
}

/// ν at one node. 12 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct IndexEntry {
    /// ν at the node.
    pub value: f32,
    /// Its slope from there to the next node, per table cell; a difference of two values would lose digits.
    pub slope: f32,
    /// How many jumps of ν lie at or below it.
    pub jumps: u32,
}
