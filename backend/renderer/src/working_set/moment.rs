//! What is asked of a working set at a moment.

use super::IndexRules;
use bricks::{NodeKey, NodeSummary};

/// How many times as fast detail appears and goes while nothing else changes: then pictures are eased as well, see
/// `render::easing`, and shares need not be what keeps them from changing fast.
const HURRY: f64 = 4.0;

/// What is asked of an update besides what rays found.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The rules of the frame.
    pub rules: IndexRules<'a>,
    /// Bounds of the values of a node inside the volume.
    pub summary: &'a dyn Fn(NodeKey) -> NodeSummary,
    /// Now, seconds on a clock that does not run back.
    pub now_s: f64,
    /// Whether nothing has changed since the last frame but the time.
    pub is_still: bool,
    /// Time in which detail appears or goes, seconds; 0 is at once.
    pub fade_s: f64,
    /// Bricks that may be asked for and not be there yet.
    pub most_in_flight: usize,
}

impl Moment<'_> {
    /// The time of a fade in a still view or a moving one, where `fade_s` was asked for.
    pub fn fade_of(fade_s: f64, is_still: bool) -> f64 {
        if is_still { fade_s / HURRY } else { fade_s }
    }
}
