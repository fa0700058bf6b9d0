//! Pixels of marks.

use display_config::Ray;
use protocol::Paint;
use std::cmp::Ordering;

/// What a mark adds to one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragment {
    /// The pixel's place in the picture, row by row.
    pub pixel: u32,
    /// Its colour; the opacity is that of what it covers of the pixel.
    pub paint: Paint,
    /// Where it lies, if the volume may hide it; None where it shines through.
    pub place: Option<FragmentPlace>,
}

/// Where a fragment lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragmentPlace {
    /// On the ray of its pixel,
    pub ray: Ray,
    /// so far from the ray's start, metres.
    pub distance_m: f64,
}

/// The order in which fragments are laid one over the other: pixel by pixel, the farthest first, and last what shines through. Those
/// as far stay in their order.
pub(crate) fn order(a: &Fragment, b: &Fragment) -> Ordering {
    a.pixel.cmp(&b.pixel).then_with(|| match (&a.place, &b.place) {
        (Some(a), Some(b)) => b.distance_m.total_cmp(&a.distance_m),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => Ordering::Equal,
    })
}
