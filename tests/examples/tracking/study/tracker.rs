//! A simulated tracker: what it measures of a hand, and when.

use super::hand::Hand;
use super::random::Random;
use glam::DQuat;
use std::time::Duration;
use tracking::Pose;

/// RMS error along each axis, metres and radians.
const NOISE: (f64, f64) = (3e-4, 2e-3);
/// Samples come as much earlier or later than their time, as a share of the interval.
const JITTER: f64 = 0.15;
/// One sample in so many is lost, and one in so many begins a loss of many.
const LOST_ONE_IN: f64 = 100.0;
const HIDDEN_ONE_IN: f64 = 1000.0;
/// How long a target is hidden then, seconds.
const HIDDEN_S: f64 = 0.15;

/// A sample: its time, and the pose unless the target was lost.
pub type Sample = (Duration, Option<Pose>);

/// What a tracker with a rate measures of a hand during a time.
pub fn measure(hand: &Hand, rate_hz: f64, time_s: f64, random: &mut Random) -> Vec<Sample> {
    let mut hidden_until_s = 0.0;
    let mut sample = |n: u32| {
        let at_s = (f64::from(n) + random.between(-JITTER, JITTER)).max(0.0) / rate_hz;
        let (position_m, rotation) = hand.place(at_s);
        let error = DQuat::from_scaled_axis(NOISE.1 * random.vector());
        let pose = Pose::new(position_m + NOISE.0 * random.vector(), error * rotation);
        let luck = random.uniform();
        if luck < 1.0 / HIDDEN_ONE_IN {
            hidden_until_s = at_s + HIDDEN_S;
        }
        let is_lost = at_s < hidden_until_s || luck < 1.0 / LOST_ONE_IN;
        (Duration::from_secs_f64(at_s), pose.filter(|_| !is_lost))
    };
    (0..(time_s * rate_hz) as u32).map(&mut sample).collect()
}
