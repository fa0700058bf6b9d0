//! Checks of single values of a scene file.

use super::SceneError;
use super::file::{Limits, Number, Triple};
use super::text::SceneText;
use glam::DVec3;
use std::ops::RangeInclusive;

type Checked<T> = Result<T, SceneError>;

impl SceneText {
    pub fn finite(&self, number: &Number) -> Checked<f64> {
        self.within(number, f64::MIN..=f64::MAX)
    }

    pub fn above_zero(&self, number: &Number) -> Checked<f64> {
        self.within(number, f64::MIN_POSITIVE..=f64::MAX)
    }

    pub fn within(&self, number: &Number, range: RangeInclusive<f64>) -> Checked<f64> {
        let value = *number.get_ref();
        let expected = match (*range.start(), *range.end()) {
            (f64::MIN, _) => "a finite number".to_owned(),
            (f64::MIN_POSITIVE, _) => "a finite number above 0".to_owned(),
            (low, f64::MAX) => format!("a finite number of at least {low}"),
            (low, high) => format!("a number from {low} to {high}"),
        };
        let message = || format!("it is {value}; give {expected}");
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
        let [low, high] = *limits.get_ref();
        let is_rising = low.is_finite() && high.is_finite() && low < high;
        let message =
            || format!("[{low}, {high}] is not a rising interval of finite numbers; give [low, high]");
        is_rising.then_some((low, high)).ok_or_else(|| self.wrong(limits.span(), message()))
    }

    pub fn point(&self, triple: &Triple) -> Checked<DVec3> {
        let point = DVec3::from_array(*triple.get_ref());
        let message = "it holds an infinite number or NaN; give three ordinary numbers";
        point.is_finite().then_some(point).ok_or_else(|| self.wrong(triple.span(), message))
    }

    pub fn optional_point(&self, triple: &Option<Triple>) -> Checked<Option<DVec3>> {
        triple.as_ref().map(|triple| self.point(triple)).transpose()
    }

    pub fn before_screen(&self, triple: &Triple) -> Checked<DVec3> {
        let point = self.point(triple)?;
        let message =
            || format!("the observer is at z = {}; it must stand before the screen, at z > 0", point.z);
        (point.z > 0.0).then_some(point).ok_or_else(|| self.wrong(triple.span(), message()))
    }

    pub fn direction(&self, triple: &Triple) -> Checked<DVec3> {
        let direction = self.point(triple)?.try_normalize();
        direction.ok_or_else(|| self.wrong(triple.span(), "it has no length; give a direction"))
    }
}
