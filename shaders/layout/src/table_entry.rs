//! An entry of a pre-integrated transfer function.

use bytemuck::{Pod, Zeroable};

/// f and F = ∫ f of (k red, k green, k blue, τ) at one node of the table. F is the sum of two f32, so that the
/// difference of two integrals keeps its digits where a spike stands beside an almost empty range. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OpticsEntry {
    /// f at the node.
    pub value: [f32; 4],
    /// F at the node, rounded to f32; in units of table cells.
    pub integral: [f32; 4],
    /// What the rounding left of F.
    pub integral_rest: [f32; 4],
}

/// The same for the importance alone, padded to 16 bytes.
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
