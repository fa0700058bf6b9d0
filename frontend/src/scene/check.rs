//! Checks of single values of a scene file.

use super::SceneError;
use super::file::{Key, Limits, Number, Triple};
use super::text::SceneText;
use display_config::text::brief_number;
use glam::DVec3;
use optics::OutOfBounds;
use std::ops::{Range, RangeInclusive};

type Checked<T> = Result<T, SceneError>;

/// Coordinates of points and degrees of turns, at most: kernels compute in f32, and nothing is a thousand kilometres away.
const FARTHEST: f64 = 1e6;

impl SceneText {
    pub fn finite(&self, number: &Number) -> Checked<f64> {
        self.within(number, f64::MIN..=f64::MAX)
    }

    pub fn within(&self, number: &Number, range: RangeInclusive<f64>) -> Checked<f64> {
        let value = *number.get_ref();
        let expected = match (*range.start(), *range.end()) {
            (f64::MIN, _) => "a finite number".to_owned(),
            (f64::MIN_POSITIVE, _) => "a finite number above 0".to_owned(),
            (low, f64::MAX) => format!("a finite number of at least {low}"),
            (low, high) => format!("a number from {low} to {high}"),
        };
        let message = || format!("it is {}; give {expected}", brief_number(value));
        range.contains(&value).then_some(value).ok_or_else(|| self.wrong(number.span(), message()))
    }

    /// The number, or `otherwise` if there is none.
    pub fn within_or(
        &self,
        number: &Option<Number>,
        otherwise: f64,
        range: RangeInclusive<f64>,
    ) -> Checked<f64> {
        number.as_ref().map_or(Ok(otherwise), |number| self.within(number, range))
    }

    /// Two finite numbers, the first below the second.
    pub fn rising(&self, limits: &Limits) -> Checked<(f64, f64)> {
        let [low, high] = limits.get_ref().0;
        let is_rising = low.is_finite() && high.is_finite() && low < high;
        let shown = || format!("[{}, {}]", brief_number(low), brief_number(high));
        let message = || format!("{} is not a rising interval of finite numbers; give [low, high]", shown());
        is_rising.then_some((low, high)).ok_or_else(|| self.wrong(limits.span(), message()))
    }

    pub fn point(&self, triple: &Triple) -> Checked<DVec3> {
        let point = DVec3::from_array(triple.get_ref().0);
        let is_near = point.is_finite() && point.abs().max_element() <= FARTHEST;
        let message =
            "it holds an infinite number, NaN, or one beyond a million; give three ordinary numbers";
        is_near.then_some(point).ok_or_else(|| self.wrong(triple.span(), message))
    }

    pub fn optional_point(&self, triple: &Option<Triple>) -> Checked<Option<DVec3>> {
        triple.as_ref().map(|triple| self.point(triple)).transpose()
    }

    pub fn before_screen(&self, triple: &Triple) -> Checked<DVec3> {
        let point = self.point(triple)?;
        let message = || {
            format!(
                "the observer is at z = {}; it must stand before the screen, at z > 0",
                brief_number(point.z)
            )
        };
        (point.z > 0.0).then_some(point).ok_or_else(|| self.wrong(triple.span(), message()))
    }

    pub fn direction(&self, triple: &Triple) -> Checked<DVec3> {
        let direction = DVec3::from_array(triple.get_ref().0).try_normalize();
        let message = "it has no length, or none that a direction could have; give three ordinary numbers";
        direction.ok_or_else(|| self.wrong(triple.span(), message))
    }

    /// Refuses what the renderer would refuse, at the key of the number that is out of its bounds; `otherwise` is the place
    /// where none of the keys is given.
    pub fn within_bounds(
        &self,
        checked: Result<(), OutOfBounds>,
        keys: impl IntoIterator<Item = Key>,
        otherwise: Range<usize>,
    ) -> Checked<()> {
        let Err(OutOfBounds { name, value, expected }) = checked else { return Ok(()) };
        let given = keys.into_iter().find(|(key, _)| *key == name).map(|(_, span)| span);
        let message = format!("{name} is {}; it must be {expected}", brief_number(value));
        Err(self.wrong(given.unwrap_or(otherwise), message))
    }
}
