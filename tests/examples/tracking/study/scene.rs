//! A hand and what a tracker measured of it.

use super::hand::{Hand, Motion};
use super::random::Random;
use super::score::Score;
use super::tracker::{Sample, measure};
use super::viewer::{Method, view};
use std::time::Duration;
use tracking::TrackSettings;

const SEED: u64 = 72;
/// How long it is looked at, seconds, and how much longer the hand goes on.
const TIME_S: f64 = 120.0;
const AFTER_S: f64 = 1.0;

/// One motion under one tracker.
pub struct Scene {
    motion: Motion,
    hand: Hand,
    samples: Vec<Sample>,
}

impl Scene {
    /// What a hand with tremor does under a tracker with a rate.
    pub fn new(motion: Motion, rate_hz: f64) -> Self {
        Self::of(motion, true, rate_hz)
    }

    /// A tool in a stand, under the same.
    pub fn stand(rate_hz: f64) -> Self {
        Self::of(Motion::Hold, false, rate_hz)
    }

    fn of(motion: Motion, has_tremor: bool, rate_hz: f64) -> Self {
        let mut random = Random(SEED);
        let hand = Hand::new(motion, has_tremor, TIME_S + AFTER_S, &mut random);
        let samples = measure(&hand, rate_hz, TIME_S, &mut random);
        Self { motion, hand, samples }
    }

    /// How well a method shows it: the jitter of what is held still, the error of what moves.
    pub fn score(&self, latency_ms: u64, method: Method, settings: &TrackSettings) -> Score {
        let latency = Duration::from_millis(latency_ms);
        let shown = view(&self.hand, &self.samples, TIME_S, latency, method, settings);
        match self.motion {
            Motion::Hold => Score::of_jitter(&shown),
            _ => Score::of_error(&shown),
        }
    }
}
