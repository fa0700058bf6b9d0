//! The lag that the filter adds at even speeds, against theory.

use super::hand::{Hand, Motion};
use super::page::{Page, head, row, section};
use super::random::Random;
use std::f64::consts::TAU;
use std::time::Duration;
use tracking::{Pose, PoseFilter, TrackSettings};

const SPEEDS_M_PER_S: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0];
/// Samples a second, and how many until the lag has settled.
const RATE_HZ: f64 = 60.0;
const SAMPLES: u32 = 600;

/// A table of measured lags, without noise, and those that theory expects.
pub fn table(page: &mut Page<'_>) {
    section(page, "Lag of the filter", "At an even speed, without noise and without prediction.");
    head(page, &["speed, m/s", "lag, mm", "in theory, mm", "lag, ms"].map(str::to_owned));
    let position = TrackSettings::default().position;
    for speed in SPEEDS_M_PER_S {
        let lag_mm = 1e3 * measured(speed);
        let cutoff_hz = position.least_cutoff_hz + position.cutoff_per_speed * speed;
        let expected_mm = 1e3 * speed / (TAU * cutoff_hz);
        let cells = [format!("{lag_mm:.2}"), format!("{expected_mm:.2}"), format!("{:.1}", lag_mm / speed)];
        row(page, &speed.to_string(), &cells);
    }
}

/// Metres.
fn measured(speed: f64) -> f64 {
    let settings = TrackSettings::default();
    let hand = Hand::new(Motion::Glide(speed), false, 0.0, &mut Random(0));
    let mut filter = PoseFilter::new(settings.position, settings.rotation);
    let lag = |n: u32| {
        let at_s = f64::from(n) / RATE_HZ;
        let (position_m, rotation) = hand.place(at_s);
        let pose = Pose::new(position_m, rotation).expect("a hand is near");
        filter.step(Duration::from_secs_f64(at_s), pose).position_m().distance(position_m)
    };
    (0..SAMPLES).map(lag).last().unwrap_or_default()
}
