//! Slices in their order, one at each place, and where their stack lies.

use super::header::{Frame, MOMENT_NAMES, Pose};
use super::scan::Series;
use crate::Selection;
use crate::choice::{Several, only_one};
use bricks::volume::{Space, VolumeError, VolumeFrame};
use glam::{DMat3, DVec3};
use std::path::Path;

/// Positions that differ less are one place, mm.
const SAME_PLACE_MM: f64 = 1e-3;
/// A step may differ from the mean by this share of it, and ...
const STEP_TOLERANCE: f64 = 0.01;
/// ... by this, mm: positions are decimal numbers, often of two digits after the point.
const STEP_ROUNDING_MM: f64 = 0.005;
/// A step of so many times the usual one, less the tolerance, has room for a slice that is not there.
const GAP_STEPS: f64 = 2.0;
/// Edge of a voxel of which nothing is said, mm.
const UNKNOWN_MM: f64 = 1.0;
/// Most places or pairs that a sentence lists.
const MOST_LISTED: usize = 3;

/// Slices along the stack, and its frame.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    pub slices: Vec<Frame>,
    pub frame: VolumeFrame,
}

/// Orders the frames of a series and chooses one per place.
pub(super) fn stack(path: &Path, series: Series, selection: &Selection) -> Result<Stack, VolumeError> {
    let wrong = |what| Err(VolumeError::unsupported(path, what));
    let Some(pose) = series[0].pose else {
        only_one(path, Several::Times, selection.time)?;
        return Ok(stack_without_positions(path, series, selection));
    };
    if !pose.position_mm.is_finite() || pose.normal().length() < 0.5 {
        return wrong(format!("{} has an orientation or position that cannot be", series[0].name()));
    }
    let slices = match one_per_place(places(series, &pose), selection.time) {
        Ok(slices) => slices,
        Err(what) => return wrong(what),
    };
    let frame = match selection.spacing_mm {
        // Who gives the spacing vouches for it.
        Some(spacing_mm) => VolumeFrame::of_voxels(spacing_mm * 1e-3),
        None => match check_steps(&slices, &pose) {
            Ok(()) => frame_of(path, &slices, &pose),
            Err(what) => return wrong(what),
        },
    };
    Ok(Stack { slices, frame })
}

/// A scanner's image without a place in the patient: in the order of the instance numbers.
fn stack_without_positions(path: &Path, mut series: Series, selection: &Selection) -> Stack {
    series.sort_by(|a, b| compare_moments(a, b).then(a.index.cmp(&b.index)));
    let spacing_mm = selection.spacing_mm.unwrap_or_else(|| {
        tracing::warn!(path = %path.display(), "no positions: slices are in the order of their instance numbers");
        voxel_mm(path, &series[0])
    });
    Stack { frame: VolumeFrame::of_voxels(spacing_mm * 1e-3), slices: series }
}

/// Edges of a voxel from one slice alone, mm.
fn voxel_mm(path: &Path, slice: &Frame) -> DVec3 {
    let [x, y] = slice.spacing_mm.unwrap_or_else(|| {
        tracing::warn!(path = %path.display(), "no pixel spacing: 1 mm is assumed");
        [UNKNOWN_MM; 2]
    });
    DVec3::new(x, y, slice.slice_spacing_mm.filter(|&mm| mm > 0.0).unwrap_or(x))
}

/// The frames at each place, places in order along the normal.
fn places(mut series: Series, pose: &Pose) -> Vec<Vec<Frame>> {
    let normal = pose.normal();
    let height = |frame: &Frame| along(frame, normal);
    series.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let mut places: Vec<Vec<Frame>> = Vec::new();
    for frame in series {
        match places.last_mut() {
            Some(place) if height(&frame) - height(&place[0]) < SAME_PLACE_MM => place.push(frame),
            _ => places.push(vec![frame]),
        }
    }
    for place in &mut places {
        place.sort_by(compare_moments);
    }
    places
}

/// Place of a frame along the stack, mm.
fn along(frame: &Frame, normal: DVec3) -> f64 {
    frame.pose.map_or(0.0, |pose| pose.position_mm.dot(normal))
}

fn compare_moments(a: &Frame, b: &Frame) -> std::cmp::Ordering {
    let key = |moment: Option<f64>| moment.unwrap_or(f64::NEG_INFINITY);
    let pairs = a.moment.iter().zip(&b.moment).map(|(&a, &b)| key(a).total_cmp(&key(b)));
    let by_moment = pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then);
    by_moment.then_with(|| a.file.path.cmp(&b.file.path))
}

/// Of several images at each place the one of that time; without a time there must be one.
fn one_per_place(places: Vec<Vec<Frame>>, time: Option<u32>) -> Result<Vec<Frame>, String> {
    let fewest = places.iter().map(Vec::len).min().unwrap_or(0);
    let most = places.iter().map(Vec::len).max().unwrap_or(0);
    match time.map(|time| time as usize).or((most == 1).then_some(0)) {
        Some(time) if time < fewest => {
            Ok(places.into_iter().map(|mut place| place.swap_remove(time)).collect())
        }
        Some(time) => Err(format!("time {time} is asked for, and {}", counts(&places, fewest, most))),
        None if fewest == most => {
            Err(format!("{}; choose one by its time, 0 to {}", counts(&places, fewest, most), most - 1))
        }
        None => Err(format!("{}; remove what does not belong", counts(&places, fewest, most))),
    }
}

/// How many images lie at the places, and what distinguishes them.
fn counts(places: &[Vec<Frame>], fewest: usize, most: usize) -> String {
    let differing = |place: &Vec<Frame>| -> Vec<&str> {
        let differs = |&i: &usize| place.iter().any(|frame| frame.moment[i] != place[0].moment[i]);
        (0..MOMENT_NAMES.len()).filter(differs).map(|i| MOMENT_NAMES[i]).collect()
    };
    let words = |place: &Vec<Frame>| match differing(place) {
        tags if tags.is_empty() => "nothing distinguishes them".to_owned(),
        tags => format!("they differ in {}", tags.join(", ")),
    };
    if fewest == most {
        return format!("{most} images lie at each of the {} places ({})", places.len(), words(&places[0]));
    }
    let several = places.iter().filter(|place| place.len() > fewest);
    let list: Vec<String> = several.clone().take(MOST_LISTED).map(|place| names(place)).collect();
    let rest = several.count() - list.len();
    let rest = if rest > 0 { format!(" and {rest} places more") } else { String::new() };
    format!("from {fewest} to {most} images lie at the same place: {}{rest}", list.join("; "))
}

fn names(place: &[Frame]) -> String {
    let names: Vec<String> = place.iter().map(Frame::name).collect();
    names.join(" and ")
}

/// Whether the slices are evenly spaced; otherwise where they are not.
fn check_steps(slices: &[Frame], pose: &Pose) -> Result<(), String> {
    let normal = pose.normal();
    let steps: Vec<f64> =
        slices.windows(2).map(|pair| along(&pair[1], normal) - along(&pair[0], normal)).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(&usual) = sorted.get(sorted.len().saturating_sub(1) / 2) else {
        return Ok(());
    };
    let tolerance = (STEP_TOLERANCE * usual + STEP_ROUNDING_MM).min(0.05 * usual);
    let between = |i: usize| {
        let place = along(&slices[i], normal);
        format!(
            "between {} at {place:.2} mm and {} at {:.2} mm",
            slices[i].name(),
            slices[i + 1].name(),
            place + steps[i]
        )
    };
    let wrong: Vec<usize> = (0..steps.len()).filter(|&i| (steps[i] - usual).abs() > tolerance).collect();
    let Some(&first) = wrong.first() else {
        return check_shift(slices, tolerance);
    };
    let count = |i: usize| (steps[i] / usual).round();
    let is_gap =
        |&i: &usize| count(i) >= GAP_STEPS && (steps[i] - count(i) * usual).abs() <= tolerance * count(i);
    let vouch = "or give the spacing to read them as evenly spaced";
    if wrong.iter().all(is_gap) {
        let missing: f64 = wrong.iter().map(|&i| count(i) - 1.0).sum();
        let missing = match missing as u64 {
            1 => "1 slice is missing".to_owned(),
            count => format!("{count} slices are missing"),
        };
        let gaps: Vec<String> = wrong.iter().take(MOST_LISTED).map(|&i| between(i)).collect();
        let more = if wrong.len() > MOST_LISTED { " and elsewhere" } else { "" };
        return Err(format!("{missing}, {}{more}: copy the series again, {vouch}", gaps.join(", ")));
    }
    Err(format!(
        "the slices are not evenly spaced: {:.3} mm {}, {usual:.3} mm elsewhere; resample the series, {vouch}",
        steps[first],
        between(first)
    ))
}

/// Slices that are shifted sideways, as under a tilted gantry, must be so evenly.
fn check_shift(slices: &[Frame], tolerance: f64) -> Result<(), String> {
    let position = |i: usize| slices[i].pose.map_or(DVec3::ZERO, |pose| pose.position_mm);
    let last = slices.len() - 1;
    let mean = (position(last) - position(0)) / last as f64;
    let is_off = |&i: &usize| (position(i + 1) - position(i) - mean).length() > 2.0 * tolerance;
    match (0..last).find(is_off) {
        None => Ok(()),
        Some(i) => Err(format!(
            "the slices are not above one another: {} and {} are shifted against each other; resample the series, \
             or give the spacing to read them as if they were",
            slices[i].name(),
            slices[i + 1].name()
        )),
    }
}

/// The frame of evenly spaced slices.
fn frame_of(path: &Path, slices: &[Frame], pose: &Pose) -> VolumeFrame {
    let first = slices[0].pose.unwrap_or(*pose);
    let last = slices[slices.len() - 1].pose.unwrap_or(first);
    let voxel_mm = voxel_mm(path, &slices[0]);
    let step_mm = match slices.len() {
        1 => first.normal() * voxel_mm.z,
        count => (last.position_mm - first.position_mm) / (count - 1) as f64,
    };
    let axes_mm = DMat3::from_cols(first.along_row * voxel_mm.x, first.along_column * voxel_mm.y, step_mm);
    VolumeFrame { axes_m: axes_mm * 1e-3, origin_m: first.position_mm * 1e-3, space: Space::Patient }
}
