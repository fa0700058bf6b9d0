//! Whether points can be registered at all.

use super::PointPair;
use super::error::{Frame, RegistrationError};
use super::spread::Spread;
use super::units::{cause, is_same_unit, robust_scale};
use crate::pose::FARTHEST_M;
use glam::DVec3;

/// Fewer fix no rotation.
const FEWEST: usize = 3;
/// Nobody measures more; looking for outliers takes time with their third power.
const MOST: usize = 200;
/// Two readings are never as alike as this, as a share of how far the points spread.
const SAME: f64 = 1e-7;
/// Points lie on a line if they are this slender: a turn about it would err twenty times as much as about the others.
const SLENDER: f64 = 0.05;

/// Checks count, numbers, duplicates, lines and units.
pub(super) fn check(pairs: &[PointPair]) -> Result<(), RegistrationError> {
    let count = pairs.len();
    match count {
        ..FEWEST => return Err(RegistrationError::TooFew { count }),
        FEWEST..=MOST => {}
        _ => return Err(RegistrationError::TooMany { count, most: MOST }),
    }
    pairs.iter().try_for_each(check_numbers)?;
    let all: Vec<&PointPair> = pairs.iter().collect();
    let spread = spreads(&all);
    check_duplicates(pairs, spread[0].1.length_m())?;
    if let Some((frame, spread)) = spread.iter().find(|(_, spread)| is_slender(spread)) {
        let (width_m, length_m) = (spread.width_m(), spread.length_m());
        return Err(RegistrationError::Collinear { frame: *frame, width_m, length_m });
    }
    match robust_scale(pairs) {
        scale if is_same_unit(scale) => Ok(()),
        scale => Err(RegistrationError::Units { scale, cause: cause(scale) }),
    }
}

/// Whether the points of a frame lie on a line, or nearly.
pub(super) fn is_collinear(pairs: &[&PointPair]) -> bool {
    spreads(pairs).iter().any(|(_, spread)| is_slender(spread))
}

fn spreads(pairs: &[&PointPair]) -> [(Frame, Spread); 2] {
    [
        (Frame::Tracker, Spread::of(pairs.iter().map(|pair| pair.point_in_tracker))),
        (Frame::Display, Spread::of(pairs.iter().map(|pair| pair.point_in_display))),
    ]
}

fn is_slender(spread: &Spread) -> bool {
    // Also where all points are one.
    spread.width_m() <= SLENDER * spread.length_m()
}

fn check_numbers(pair: &PointPair) -> Result<(), RegistrationError> {
    let is_near = |point: DVec3| point.to_array().iter().all(|c| (-FARTHEST_M..=FARTHEST_M).contains(c));
    let points = [(Frame::Tracker, pair.point_in_tracker), (Frame::Display, pair.point_in_display)];
    match points.into_iter().find(|(_, point)| !is_near(*point)) {
        Some((frame, _)) => Err(RegistrationError::NotAPoint { name: pair.name.clone(), frame }),
        None => Ok(()),
    }
}

/// A mark may be measured several times, and then has one place in the display frame; but no two readings of a tracker are
/// the same.
fn check_duplicates(pairs: &[PointPair], length: f64) -> Result<(), RegistrationError> {
    let is_same =
        |a: &PointPair, b: &PointPair| a.point_in_tracker.distance(b.point_in_tracker) <= SAME * length;
    for (at, first) in pairs.iter().enumerate() {
        if let Some(second) = pairs[at + 1..].iter().find(|second| is_same(first, second)) {
            let (first, second) = (first.name.clone(), second.name.clone());
            return Err(RegistrationError::Duplicate { first, second });
        }
    }
    Ok(())
}
