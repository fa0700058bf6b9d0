//! What rays report of a node.

use bytemuck::{Pod, Zeroable};

/// Feedback of one node, gathered from all rays; zero if no ray sampled it. 8 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct FeedbackEntry {
    /// The largest deficit, as a code that grows with it: see [`deficit_from_code`].
    pub deficit_code: u32,
    /// Number of rays that sampled the node.
    pub rays: u32,
}

/// Codes per level of deficit.
pub const CODES_PER_LEVEL: f32 = 256.0;
/// Code of a deficit of zero: 0 is kept for "no ray".
pub const CODE_OF_ZERO: f32 = 32768.0;
/// Deficits are held to ± this many levels.
pub const MOST_DEFICIT: f32 = 100.0;

/// Levels of deficit that a code stands for, to 1/256 level; None for "no ray".
pub fn deficit_from_code(code: u32) -> Option<f32> {
    (code > 0).then(|| (code as f32 - CODE_OF_ZERO) / CODES_PER_LEVEL)
}

/// The code of a deficit in levels, which is first held to ± [`MOST_DEFICIT`]. Rounded up: what is too coarse by however little has
/// a code above that of zero.
pub fn code_from_deficit(deficit: f32) -> u32 {
    (CODE_OF_ZERO + (deficit.clamp(-MOST_DEFICIT, MOST_DEFICIT) * CODES_PER_LEVEL).ceil()) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_keep_the_order_and_the_value() {
        assert_eq!(deficit_from_code(0), None);
        assert_eq!(deficit_from_code(code_from_deficit(1.5)), Some(1.5));
        assert!(code_from_deficit(-1.0) < code_from_deficit(0.0));
        assert!(code_from_deficit(1e-30) > code_from_deficit(0.0));
        assert!(code_from_deficit(f32::INFINITY) > code_from_deficit(3.0));
    }
}
