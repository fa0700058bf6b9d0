//! A simulated hand with a tool: where it truly is at any time.

use super::random::Random;
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// Frequencies of physiological tremor, Hz.
const TREMOR_HZ: (f64, f64) = (8.0, 12.0);
/// Its sinusoids.
const TREMOR_PARTS: usize = 5;
/// RMS of its displacement along each axis, metres, and of its rotation, radians.
const TREMOR: (f64, f64) = (3e-4, 3e-3);
/// A reach takes a time within these, and so does the rest after it, seconds.
const REACH_S: (f64, f64) = (0.6, 1.0);
const REST_S: (f64, f64) = (0.2, 0.5);
/// How far reaches go from the middle along each axis, metres, and by how much they turn, radians (standard deviations).
const REACH: (f64, f64) = (0.15, 0.5);
/// A shake: metres and radians to each side.
const SHAKE: (f64, f64) = (0.05, 0.3);
/// A circle that is traced: its radius, metres, the tilt of the tool, radians, and Hz.
const TRACE: (f64, f64, f64) = (0.1, 0.4, 0.2);

/// What a hand does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// It holds the tool still.
    Hold,
    /// It follows a contour slowly.
    Trace,
    /// It reaches from place to place, with minimum jerk (Flash and Hogan 1985), and rests at each.
    Reach,
    /// It shakes the tool so many times a second: reversals.
    Shake(f64),
    /// It moves at an even speed, m/s, without turning.
    Glide(f64),
}

/// A position, metres, and a rotation.
pub type Place = (DVec3, DQuat);

/// A hand.
pub struct Hand {
    motion: Motion,
    /// Frequency, Hz, and amplitudes and phases of displacement and rotation along each axis; none for a machine's hand.
    tremor: Vec<(f64, DVec3, DVec3)>,
    /// Begin and end of each reach, seconds, and where it goes: a turn as a vector.
    reaches: Vec<(f64, f64, DVec3, DVec3)>,
}

impl Hand {
    /// A hand that does something for a time, with tremor or without.
    pub fn new(motion: Motion, has_tremor: bool, time_s: f64, random: &mut Random) -> Self {
        let parts = if has_tremor { TREMOR_PARTS } else { 0 };
        let phases = |random: &mut Random| TAU * DVec3::from_array(std::array::from_fn(|_| random.uniform()));
        let part = |_| (random.between(TREMOR_HZ.0, TREMOR_HZ.1), phases(random), phases(random));
        let tremor = (0..parts).map(part).collect();
        let (mut reaches, mut at_s) = (Vec::new(), 0.0);
        while at_s < time_s {
            let end_s = at_s + random.between(REACH_S.0, REACH_S.1);
            reaches.push((at_s, end_s, REACH.0 * random.vector(), REACH.1 * random.vector()));
            at_s = end_s + random.between(REST_S.0, REST_S.1);
        }
        Self { motion, tremor, reaches }
    }

    /// Where the tool is.
    pub fn place(&self, at_s: f64) -> Place {
        let (position, turn) = self.intended(at_s);
        let part = |(hz, phase, other): &(f64, DVec3, DVec3)| {
            let wave = |phase: &DVec3| phase.map(|phase| (TAU * hz * at_s + phase).sin());
            (wave(phase), wave(other))
        };
        let each = (2.0 / TREMOR_PARTS as f64).sqrt();
        let (moved, turned) = self.tremor.iter().map(part).fold((position, DVec3::ZERO), |sum, part| {
            (sum.0 + each * TREMOR.0 * part.0, sum.1 + each * TREMOR.1 * part.1)
        });
        (moved, DQuat::from_scaled_axis(turned) * DQuat::from_scaled_axis(turn))
    }

    /// Without tremor, with the rotation as a vector.
    fn intended(&self, at_s: f64) -> (DVec3, DVec3) {
        let axis = DVec3::new(2.0, 2.0, 1.0) / 3.0;
        match self.motion {
            Motion::Hold => (DVec3::new(0.1, 0.2, 0.3), 0.7 * axis),
            Motion::Trace => {
                let (radius, tilt, hz) = TRACE;
                let (sin, cos) = (TAU * hz * at_s).sin_cos();
                (radius * DVec3::new(cos, sin, 0.0), tilt * DVec3::new(-sin, cos, 0.0))
            }
            Motion::Reach => self.reached(at_s),
            Motion::Shake(hz) => {
                let (amplitude, angle) = SHAKE;
                let sin = (TAU * hz * at_s).sin();
                (amplitude * sin * axis, angle * sin * DVec3::Z)
            }
            Motion::Glide(speed) => (speed * at_s * axis, DVec3::ZERO),
        }
    }

    fn reached(&self, at_s: f64) -> (DVec3, DVec3) {
        let reach = self.reaches.partition_point(|&(begin_s, ..)| begin_s <= at_s).saturating_sub(1);
        let before = reach.checked_sub(1).map_or((DVec3::ZERO, DVec3::ZERO), |at| {
            let (.., place, turn) = self.reaches[at];
            (place, turn)
        });
        let (begin_s, end_s, place, turn) = self.reaches[reach];
        let t = ((at_s - begin_s) / (end_s - begin_s)).clamp(0.0, 1.0);
        let share = t.powi(3) * (10.0 - 15.0 * t + 6.0 * t * t);
        (before.0.lerp(place, share), before.1.lerp(turn, share))
    }
}
