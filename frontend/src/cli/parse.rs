//! Values of the command line: points, sizes, lengths.

use glam::{DVec3, UVec2, UVec3};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

/// Three numbers within a million.
pub(super) fn point(text: &str) -> Result<DVec3, String> {
    let point = DVec3::from_array(three::<f64>(text)?);
    let is_near = point.is_finite() && point.abs().max_element() <= 1e6;
    is_near.then_some(point).ok_or_else(|| "give three numbers from -1000000 to 1000000".to_owned())
}

/// Three lengths above 0.
pub(super) fn spacing(text: &str) -> Result<DVec3, String> {
    let spacing = point(text)?;
    if spacing.min_element() > 0.0 { Ok(spacing) } else { Err("give lengths above 0".to_owned()) }
}

/// Three sizes of at least 1.
pub(super) fn dims(text: &str) -> Result<UVec3, String> {
    three_whole(text, 1)
}

/// A voxel's place.
pub(super) fn place(text: &str) -> Result<UVec3, String> {
    three_whole(text, 0)
}

fn three_whole(text: &str, least: u32) -> Result<UVec3, String> {
    let numbers = three::<u32>(text).ok().map(UVec3::from_array);
    numbers
        .filter(|numbers| numbers.min_element() >= least)
        .ok_or_else(|| format!("give three whole numbers of at least {least}, with commas between them"))
}

fn three<T: FromStr>(text: &str) -> Result<[T; 3], String> {
    let parts = text.split(',').map(|part| part.trim().parse::<T>().ok()).collect::<Option<Vec<T>>>();
    parts
        .and_then(|p| p.try_into().ok())
        .ok_or_else(|| "give three numbers with commas between them".to_owned())
}

/// A whole number within limits.
pub(super) fn whole<T>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("give a whole number from {} to {}", range.start(), range.end()))
    }
}

/// A number that is neither NaN nor infinite.
pub(super) fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "give a finite number".to_owned())
}

/// Pixels of a picture along an edge, at most.
const MOST_PIXELS: u32 = 1 << 13;

/// A width and a height in pixels with an x between them.
pub(super) fn picture_size(text: &str) -> Result<UVec2, String> {
    let sizes = text.split_once('x').and_then(|(w, h)| Some(UVec2::new(w.parse().ok()?, h.parse().ok()?)));
    sizes.filter(|size| size.min_element() > 0 && size.max_element() <= MOST_PIXELS).ok_or_else(|| {
        format!("give a width and a height such as 640x480, each from 1 to {MOST_PIXELS} pixels")
    })
}

/// Nothing runs longer, seconds: a year.
const LONGEST_S: f64 = 3.2e7;

/// A time above 0.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.trim().parse().ok().filter(|&seconds: &f64| seconds > 0.0 && seconds <= LONGEST_S);
    seconds
        .map(Duration::from_secs_f64)
        .ok_or_else(|| format!("give a number of seconds above 0 and at most {LONGEST_S}"))
}
