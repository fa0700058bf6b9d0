//! Double exponential smoothing: the line that recent samples follow, older ones counting less.
//!
//! Brown's double exponential smoothing is the fit of a line by least squares whose weights fall by a constant factor with
//! each sample (Brown 1963, "Smoothing, forecasting and prediction of discrete time series", chapter 9), and LaViola 2003,
//! "Double exponential smoothing: an alternative to Kalman filter-based predictive tracking", predicts hands by it. Here the
//! fit itself is kept, with weights that fall with time: so samples may come at any intervals.

use std::ops::{Add, Mul, Sub};

/// What lines are made of.
pub(crate) trait Vector:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}
impl<V: Copy + Default + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>> Vector for V {}

/// Weighted sums over all samples so far, of times and values against those of the newest. So a value that does not change
/// leaves no trace of rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line<V> {
    newest: V,
    /// Σ w
    weight: f64,
    /// Σ w t, with t in seconds
    times: f64,
    /// Σ w t²
    squared_times: f64,
    /// Σ w x
    values: V,
    /// Σ w t x
    products: V,
}

impl<V: Vector> Line<V> {
    /// Of one sample.
    pub fn new(newest: V) -> Self {
        let none = V::default();
        Self { newest, weight: 1.0, times: 0.0, squared_times: 0.0, values: none, products: none }
    }

    /// The newest sample.
    pub fn newest(&self) -> V {
        self.newest
    }

    /// Adds a sample `step_s` seconds after the newest; weights fall by e in `smoothing_s` seconds.
    pub fn step(&mut self, step_s: f64, value: V, smoothing_s: f64) {
        let kept = (-step_s / smoothing_s).exp();
        let change = self.newest - value;
        let values = self.values + change * self.weight;
        let products = self.products + change * self.times - values * step_s;
        let squared_times = self.squared_times + step_s * (step_s * self.weight - 2.0 * self.times);
        self.times = kept * (self.times - step_s * self.weight);
        self.squared_times = kept * squared_times;
        (self.values, self.products) = (values * kept, products * kept);
        self.weight = kept * self.weight + 1.0;
        self.newest = value;
    }

    /// The line `ahead_s` seconds after the newest sample. Samples that span much less than `smoothing_s` seconds do not tell
    /// its slope, so it departs from the newest sample only as they come to span half of that.
    pub fn at(&self, ahead_s: f64, smoothing_s: f64) -> V {
        let mean_s = self.times / self.weight;
        let variance = self.squared_times / self.weight - mean_s * mean_s;
        if variance <= 0.0 {
            return self.newest;
        }
        let mean = self.values * self.weight.recip();
        let slope = (self.products * self.weight.recip() - mean * mean_s) * variance.recip();
        let trust = (4.0 * variance / (smoothing_s * smoothing_s)).min(1.0);
        self.newest + (mean + slope * (ahead_s - mean_s)) * trust
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Noise;

    const SMOOTHING_S: f64 = 0.05;
    /// What rounding leaves after a thousand samples.
    const ROUNDING: f64 = 1e-11;

    #[test]
    fn a_line_is_continued_exactly_whatever_the_steps() {
        let (mut noise, mut at_s) = (Noise(4), 0.0);
        let truth = |at_s: f64| 3.0 - 1.7 * at_s;
        let mut line = Line::new(truth(0.0));
        for sample in 0..1000 {
            let step_s = 0.02 * noise.uniform();
            at_s += step_s;
            line.step(step_s, truth(at_s), SMOOTHING_S);
            if sample > 50 {
                let error = line.at(0.06, SMOOTHING_S) - truth(at_s + 0.06);
                assert!(error.abs() < ROUNDING, "{error}");
            }
        }
    }

    /// LaViola 2003, equations 1 to 4, with α = 1 − exp(−step / smoothing).
    #[test]
    fn with_even_steps_it_is_double_exponential_smoothing() {
        let (step_s, ahead_s, mut noise) = (1.0 / 60.0, 0.06, Noise(7));
        let alpha = 1.0 - (-step_s / SMOOTHING_S).exp();
        let value = |n: i32, noise: &mut Noise| (0.3 * f64::from(n)).sin() + 0.1 * noise.normal();
        let first = value(0, &mut noise);
        let (mut line, mut once, mut twice) = (Line::new(first), first, first);
        for n in 1..400 {
            let value = value(n, &mut noise);
            line.step(step_s, value, SMOOTHING_S);
            once = alpha * value + (1.0 - alpha) * once;
            twice = alpha * once + (1.0 - alpha) * twice;
        }
        let gain = alpha * (ahead_s / step_s) / (1.0 - alpha);
        let predicted = (2.0 + gain) * once - (1.0 + gain) * twice;
        assert!((line.at(ahead_s, SMOOTHING_S) - predicted).abs() < ROUNDING);
    }

    #[test]
    fn samples_of_one_moment_tell_no_slope() {
        let mut line = Line::new(1.0);
        line.step(1e-6, 1.001, SMOOTHING_S);
        assert!((line.at(0.06, SMOOTHING_S) - 1.001).abs() < 1e-6);
    }
}
