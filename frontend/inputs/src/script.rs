//! A path that is written down: what a tracker would say, without a tracker.

use crate::Refusal;
use crate::event::What;
use crate::pose::checked_pose;
use crate::reading::Said;
use crate::state::State;
use glam::{DQuat, DVec3};
use serde::Deserialize;
use std::time::Duration;

/// Poses per second.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1.0..=1000.0;
const USUAL_RATE_HZ: f64 = 60.0;
/// Ticks that one question answers at most: whoever asks less than once in so many misses what lies before.
const MOST_TICKS: u64 = 256;
/// No script is longer, seconds.
const LONGEST_S: f64 = 86_400.0;

/// The keys of a script.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawScript {
    rate_hz: Option<f64>,
    #[serde(default)]
    repeat: bool,
    step: Vec<RawStep>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawStep {
    at_s: f64,
    pose: Option<RawPose>,
    lost: Option<u8>,
    button: Option<RawButton>,
    axis: Option<RawAxis>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPose {
    sensor: u8,
    position_m: DVec3,
    orientation: Option<DQuat>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawButton {
    index: u8,
    is_down: bool,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawAxis {
    index: u8,
    value: f64,
}

/// One line of a script.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    at_s: f64,
    said: Said,
}

/// A script; between two poses of a sensor it goes straight and turns evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    rate_hz: f64,
    repeats: bool,
    steps: Vec<Step>,
}

impl TryFrom<RawScript> for Script {
    type Error = String;

    fn try_from(raw: RawScript) -> Result<Self, String> {
        let rate_hz = raw.rate_hz.unwrap_or(USUAL_RATE_HZ);
        if !RATES_HZ.contains(&rate_hz) {
            return Err(format!("`rate_hz` is {rate_hz}; give a number from 1 to 1000"));
        }
        let mut steps: Vec<Step> = Vec::with_capacity(raw.step.len());
        for (place, step) in raw.step.iter().enumerate() {
            let number = place + 1;
            let earliest = steps.last().map_or(0.0, |before| before.at_s);
            if !(earliest..=LONGEST_S).contains(&step.at_s) {
                return Err(format!(
                    "`at_s` of step {number} is {}; give times that do not fall, at most a day",
                    step.at_s
                ));
            }
            let said = said(step).map_err(|fault| format!("step {number}: {fault}"))?;
            steps.push(Step { at_s: step.at_s, said });
        }
        if raw.repeat && steps.last().is_none_or(|last| last.at_s == 0.0) {
            return Err("it repeats and takes no time; add a step with a later `at_s`".to_owned());
        }
        Ok(Self { rate_hz, repeats: raw.repeat, steps })
    }
}

fn said(step: &RawStep) -> Result<Said, String> {
    let refused = |refusal: Refusal| format!("{refusal}; correct the numbers");
    match (step.pose, step.lost, step.button, step.axis) {
        (Some(RawPose { sensor, position_m, orientation }), None, None, None) => {
            let pose = checked_pose(position_m, orientation.unwrap_or(DQuat::IDENTITY)).map_err(refused)?;
            Ok(Said::Pose(sensor, Some(pose)))
        }
        (None, Some(sensor), None, None) => Ok(Said::Pose(sensor, None)),
        (None, None, Some(RawButton { index, is_down }), None) => Ok(Said::Button(index, is_down)),
        (None, None, None, Some(RawAxis { index, value })) => Said::axis(index, value).map_err(refused),
        _ => Err("give one of `pose`, `lost`, `button` and `axis`".to_owned()),
    }
}

impl Script {
    /// What is so a while after the beginning.
    fn at(&self, time_s: f64) -> Vec<Said> {
        let mut said: Vec<Said> = Vec::new();
        for (place, step) in self.steps.iter().enumerate().filter(|(_, step)| step.at_s <= time_s) {
            said.retain(|before| !is_of_same(before, &step.said));
            said.push(self.between(place, step, time_s));
        }
        said
    }

    /// A step, and for a pose what lies between it and the sensor's next one.
    fn between(&self, place: usize, step: &Step, time_s: f64) -> Said {
        let next = self.steps[place + 1..].iter().find(|next| is_of_same(&next.said, &step.said));
        let (Said::Pose(sensor, Some(from)), Some(Step { at_s, said: Said::Pose(_, Some(to)) })) =
            (step.said, next)
        else {
            return step.said;
        };
        let share = ((time_s - step.at_s) / (at_s - step.at_s)).clamp(0.0, 1.0);
        let position_m = from.position_m().lerp(to.position_m(), share);
        let pose = checked_pose(position_m, from.rotation().slerp(to.rotation(), share));
        // Opposite orientations have no turn between them: then the step stays until the next.
        Said::Pose(sensor, Some(pose.unwrap_or(from)))
    }

    fn length_s(&self) -> f64 {
        self.steps.last().map_or(0.0, |last| last.at_s)
    }
}

fn is_of_same(a: &Said, b: &Said) -> bool {
    match (a, b) {
        (Said::Pose(a, _), Said::Pose(b, _)) => a == b,
        (Said::Button(a, _), Said::Button(b, _)) | (Said::Axis(a, _), Said::Axis(b, _)) => a == b,
        _ => false,
    }
}

/// A script that runs, on the clock of whoever asks: the same questions get the same answers.
pub(crate) struct Running {
    script: Script,
    began: Option<Duration>,
    tick: u64,
    state: State,
}

impl Running {
    pub const fn new(script: Script) -> Self {
        Self { script, began: None, tick: 0, state: State::new() }
    }

    /// What has happened since the last question: when on the asker's clock, when on the script's, and what.
    pub fn poll(&mut self, now: Duration, mut tell: impl FnMut(Duration, Duration, What)) {
        let began = *self.began.get_or_insert(now);
        let due = (now.saturating_sub(began).as_secs_f64() * self.script.rate_hz).floor() as u64 + 1;
        self.tick = self.tick.max(due.saturating_sub(MOST_TICKS));
        while self.tick < due {
            let time_s = self.tick as f64 / self.script.rate_hz;
            self.tick += 1;
            let is_over = !self.script.repeats && time_s > self.script.length_s() + 1.0 / self.script.rate_hz;
            if is_over {
                self.tick = due;
                return;
            }
            let own_s = if self.script.repeats { time_s % self.script.length_s() } else { time_s };
            let (received, own) = (began + Duration::from_secs_f64(time_s), Duration::from_secs_f64(own_s));
            for what in self.script.at(own_s).into_iter().filter_map(|said| self.state.change(said)) {
                tell(received, own, what);
            }
        }
    }
}

#[cfg(test)]
#[path = "script_tests.rs"]
mod tests;
