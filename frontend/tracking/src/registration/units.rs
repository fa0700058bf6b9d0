//! Whether both frames are in metres.

use super::PointPair;
use glam::DVec3;

/// Frames whose lengths differ by more than this factor are in other units.
const MOST: f64 = 2.0;
/// A scale this near to that of a unit, as a share of it, comes from that unit.
const ALIKE: f64 = 0.1;
/// Scales from the tracker's lengths to the display's, with their usual cause.
const CAUSES: [(f64, &str); 6] = [
    (0.001, "the tracker seems to speak millimetres"),
    (0.01, "the tracker seems to speak centimetres"),
    (0.0254, "the tracker seems to speak inches"),
    (0.3048, "the tracker seems to speak feet"),
    (100.0, "display_m seems to be in centimetres"),
    (1000.0, "display_m seems to be in millimetres"),
];

/// The display's lengths over the tracker's, by the medians of the distances between points: a few that are wrong do not
/// change it much. Marks that were measured several times have no distance.
pub(super) fn robust_scale(pairs: &[PointPair]) -> f64 {
    let all =
        pairs.iter().enumerate().flat_map(|(at, one)| pairs[..at].iter().map(move |other| (one, other)));
    let apart = all.filter(|(one, other)| one.point_in_display != other.point_in_display);
    let distances = apart.map(|(one, other)| {
        let in_tracker = one.point_in_tracker.distance(other.point_in_tracker);
        (in_tracker, one.point_in_display.distance(other.point_in_display))
    });
    let (in_tracker, in_display) = distances.unzip();
    median(in_display) / median(in_tracker)
}

/// The middle number; NaN of none.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The scale of the best similarity transform, symmetric in both frames (Horn 1987, section 2D).
pub(super) fn best_scale(pairs: &[PointPair]) -> f64 {
    let size = |point: fn(&PointPair) -> DVec3| {
        let centroid = pairs.iter().map(point).sum::<DVec3>() / pairs.len() as f64;
        pairs.iter().map(|pair| point(pair).distance_squared(centroid)).sum::<f64>()
    };
    (size(|pair| pair.point_in_display) / size(|pair| pair.point_in_tracker)).sqrt()
}

/// Whether a scale is that of one unit.
pub(super) fn is_same_unit(scale: f64) -> bool {
    (MOST.recip()..=MOST).contains(&scale)
}

/// What a scale comes from, as a part of a sentence.
pub(super) fn cause(scale: f64) -> &'static str {
    let is_alike = |(of_unit, _): &&(f64, &str)| (scale / of_unit - 1.0).abs() <= ALIKE;
    CAUSES.iter().find(is_alike).map_or("they are in different units", |(_, cause)| cause)
}
