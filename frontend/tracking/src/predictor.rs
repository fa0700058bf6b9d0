//! Where a tool will be.

use crate::filter::LONGEST_STEP;
use crate::line::Line;
use crate::pose::Pose;
use glam::{DQuat, DVec3, DVec4};
use std::time::Duration;

/// Nothing is predicted farther ahead.
const MOST_AHEAD: Duration = Duration::from_millis(60);

/// A predictor of poses by double exponential smoothing, of positions and of the components of quaternions.
#[derive(Clone, Debug, PartialEq)]
pub struct PosePredictor {
    smoothing_s: f64,
    last: Option<Course>,
}

/// The newest pose, and the lines that lead there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Course {
    at: Duration,
    pose: Pose,
    position: Line<DVec3>,
    rotation: Line<DVec4>,
}

impl PosePredictor {
    /// A predictor that has seen nothing. Samples count less by a factor of e for each `smoothing` that they are older.
    pub fn new(smoothing: Duration) -> Self {
        Self { smoothing_s: smoothing.as_secs_f64(), last: None }
    }

    /// Takes a sample in. After a silence of more than 100 ms it begins anew; one that is not later than the last changes
    /// nothing.
    pub fn step(&mut self, at: Duration, pose: Pose) {
        let next = match self.last {
            Some(last) if at <= last.at => last,
            Some(last) if at - last.at <= LONGEST_STEP => last.next(at, pose, self.smoothing_s),
            _ => Course {
                at,
                pose,
                position: Line::new(pose.position_m()),
                rotation: Line::new(pose.rotation().into()),
            },
        };
        self.last = Some(next);
    }

    /// The pose at a time, at most 60 ms after the newest sample: what is asked for beyond that is as it is then, and before
    /// the sample as it is at the sample. None before any sample.
    pub fn pose_at(&self, at: Duration) -> Option<Pose> {
        let last = self.last?;
        let ahead_s = at.saturating_sub(last.at).min(MOST_AHEAD).as_secs_f64();
        let position_m = last.position.at(ahead_s, self.smoothing_s);
        let rotation = DQuat::from_vec4(last.rotation.at(ahead_s, self.smoothing_s));
        // A wild course may lead nowhere.
        Some(Pose::new(position_m, rotation).unwrap_or(last.pose))
    }
}

impl Course {
    fn next(mut self, at: Duration, pose: Pose, smoothing_s: f64) -> Self {
        let step_s = (at - self.at).as_secs_f64();
        self.position.step(step_s, pose.position_m(), smoothing_s);
        // q and −q are one rotation: the line takes the one that is nearer.
        let components = DVec4::from(pose.rotation());
        let is_near = self.rotation.newest().dot(components) >= 0.0;
        self.rotation.step(step_s, if is_near { components } else { -components }, smoothing_s);
        Self { at, pose, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMOOTHING: Duration = Duration::from_millis(12);
    /// What rounding leaves, metres.
    const ROUNDING: f64 = 1e-10;

    /// The error 60 ms ahead, metres and radians, after a second of an even motion.
    fn error(rotation_per_s: f64) -> (f64, f64) {
        let velocity = DVec3::new(0.7, -0.2, 1.5);
        let place = |at: Duration| {
            let turn = rotation_per_s * at.as_secs_f64() * DVec3::new(0.6, 0.0, 0.8);
            Pose::new(velocity * at.as_secs_f64(), DQuat::from_scaled_axis(turn)).unwrap()
        };
        let mut predictor = PosePredictor::new(SMOOTHING);
        let mut times = (0..60).map(|n| Duration::from_micros(16_667 * n + 2_000 * (n % 3)));
        times.clone().for_each(|at| predictor.step(at, place(at)));
        let seen_at = times.next_back().unwrap() + MOST_AHEAD;
        let (found, truth) = (predictor.pose_at(seen_at).unwrap(), place(seen_at));
        let angle = found.rotation().angle_between(truth.rotation());
        (found.position_m().distance(truth.position_m()), angle)
    }

    #[test]
    fn even_motion_is_predicted_exactly() {
        let (distance_m, angle) = error(0.0);
        assert!(distance_m < ROUNDING && angle < ROUNDING, "{distance_m} {angle}");
        // A line of quaternions leaves the sphere: the angle errs by the cube of the turn within the prediction.
        let angles = [1.0, 2.0, 4.0].map(|rotation_per_s| error(rotation_per_s).1);
        assert!(angles[0] < 1e-4 && angles[2] < 64.0 * 1.1 * angles[0], "{angles:?}");
        assert!(angles[1] > 4.0 * angles[0], "the canary: by more than the square, {angles:?}");
    }

    #[test]
    fn nothing_is_predicted_beyond_sixty_milliseconds_or_backward() {
        let mut predictor = PosePredictor::new(SMOOTHING);
        let at = |ms: u64| Duration::from_millis(1000 + ms);
        assert_eq!(predictor.pose_at(at(0)), None);
        for ms in (0..=400).step_by(8) {
            predictor.step(at(ms), Pose::new(DVec3::X * ms as f64 * 1e-3, DQuat::IDENTITY).unwrap());
        }
        let x_m = |ms: u64| predictor.pose_at(at(ms)).unwrap().position_m().x;
        assert!((x_m(460) - 0.46).abs() < ROUNDING && (x_m(380) - 0.4).abs() < ROUNDING);
        assert_eq!(x_m(100_000), x_m(460));
    }
}
