//! The one-euro filter: a low-pass filter whose cutoff rises with speed.
//!
//! Casiez, Roussel and Vogel 2012, "1€ filter: a simple speed-based low-pass filter for noisy input in interactive systems".
//! A still hand is filtered strongly, so that it does not jitter, and a fast one hardly, so that it does not lag.

use glam::DVec3;
use std::f64::consts::TAU;

/// How strongly a quantity is filtered. Its unit u is the metre for positions and the radian for rotations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneEuro {
    /// Cutoff at rest, Hz, above 0: smaller jitters less.
    pub least_cutoff_hz: f64,
    /// By how much the cutoff rises with speed, Hz per u/s, 0 or more: larger lags less. Casiez's β.
    pub cutoff_per_speed: f64,
    /// Cutoff of the filter of the velocity itself, Hz, above 0.
    pub velocity_cutoff_hz: f64,
}

impl OneEuro {
    /// The share of the way to a new sample that the filter goes after `step_s` seconds, from the velocity of the sample
    /// against the one before, in u/s. `velocity` is the filter's own, which this updates. It is filtered as a vector,
    /// so that noise averages out before its length is taken, and so that no direction is preferred.
    ///
    /// At an even speed v the filter lags behind by v / (2π (least cutoff + cutoff per speed · v)), whatever the steps:
    /// by less than 1 / (2π · cutoff per speed).
    pub(crate) fn share(&self, velocity: &mut DVec3, sample_velocity: DVec3, step_s: f64) -> f64 {
        *velocity += low_pass(self.velocity_cutoff_hz, step_s) * (sample_velocity - *velocity);
        low_pass(self.least_cutoff_hz + self.cutoff_per_speed * velocity.length(), step_s)
    }
}

/// The weight of a new sample in a first-order low-pass filter.
fn low_pass(cutoff_hz: f64, step_s: f64) -> f64 {
    let steps_per_radian = TAU * cutoff_hz * step_s;
    steps_per_radian / (1.0 + steps_per_radian)
}
