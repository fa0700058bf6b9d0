//! The filter of a tracked tool's poses.

use crate::one_euro::OneEuro;
use crate::pose::Pose;
use crate::turn::{turn_between, turned_toward};
use glam::DVec3;
use std::time::Duration;

/// After a longer silence a filter begins anew: what was before says nothing of what is.
pub(crate) const LONGEST_STEP: Duration = Duration::from_millis(100);

/// A one-euro filter for positions, and one for rotations.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseFilter {
    position: OneEuro,
    rotation: OneEuro,
    last: Option<Filtered>,
}

/// What the filter remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Filtered {
    at: Duration,
    sample: Pose,
    pose: Pose,
    /// Filtered, m/s.
    velocity: DVec3,
    /// The same of the rotation, rad/s.
    turning: DVec3,
}

impl PoseFilter {
    /// A filter that has seen nothing.
    pub fn new(position: OneEuro, rotation: OneEuro) -> Self {
        Self { position, rotation, last: None }
    }

    /// The filtered pose after a sample. The first one, and one after a silence of more than 100 ms, is taken as it is. One
    /// that is not later than the last changes nothing.
    pub fn step(&mut self, at: Duration, sample: Pose) -> Pose {
        let next = match self.last {
            Some(last) if at <= last.at => last,
            Some(last) if at - last.at <= LONGEST_STEP => self.filtered(&last, at, sample),
            _ => Filtered { at, sample, pose: sample, velocity: DVec3::ZERO, turning: DVec3::ZERO },
        };
        self.last = Some(next);
        next.pose
    }

    fn filtered(&self, last: &Filtered, at: Duration, sample: Pose) -> Filtered {
        let step_s = (at - last.at).as_secs_f64();
        let (mut velocity, mut turning) = (last.velocity, last.turning);
        let moved = sample.position_m() - last.sample.position_m();
        let share = self.position.share(&mut velocity, moved / step_s, step_s);
        let position_m = last.pose.position_m() + share * (sample.position_m() - last.pose.position_m());
        let turned = turn_between(last.sample.rotation(), sample.rotation());
        let share = self.rotation.share(&mut turning, turned / step_s, step_s);
        let rotation = turned_toward(last.pose.rotation(), sample.rotation(), share);
        // Between two poses there is always one; the sample stands in for what rounding could spoil.
        let pose = Pose::new(position_m, rotation).unwrap_or(sample);
        Filtered { at, sample, pose, velocity, turning }
    }
}

#[cfg(test)]
#[path = "filter_tests.rs"]
mod tests;
