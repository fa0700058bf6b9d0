//! A mark, seen from both frames.

use glam::DVec3;

/// The same point of the world in the tracker's frame and in the display's.
#[derive(Clone, Debug, PartialEq)]
pub struct PointPair {
    /// What messages call it.
    pub name: String,
    /// Where the tracker saw it, metres.
    pub point_in_tracker: DVec3,
    /// Where it is, metres.
    pub point_in_display: DVec3,
}
