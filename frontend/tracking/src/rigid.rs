//! A rotation and a translation, from one frame to another.

use crate::pose::Pose;
use glam::{DQuat, DVec3};

/// A rigid transform: `display_from_tracker.point(point_in_tracker)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidTransform {
    /// Of unit length.
    pub rotation: DQuat,
    /// After the rotation, metres.
    pub translation_m: DVec3,
}

impl RigidTransform {
    /// A point, metres, in the other frame.
    pub fn point(&self, point_m: DVec3) -> DVec3 {
        self.rotation * point_m + self.translation_m
    }

    /// A pose in the other frame; None where that is too far away to be one.
    pub fn pose(&self, pose: &Pose) -> Option<Pose> {
        Pose::new(self.point(pose.position_m()), self.rotation * pose.rotation())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_body_move_with_its_pose() {
        let display_from_tracker = RigidTransform {
            rotation: DQuat::from_rotation_y(0.7),
            translation_m: DVec3::new(0.1, -2.0, 1.5),
        };
        let in_tracker = Pose::new(DVec3::new(0.3, 0.2, 0.1), DQuat::from_rotation_x(1.1)).unwrap();
        let in_display = display_from_tracker.pose(&in_tracker).unwrap();
        let place = |pose: &Pose, point: DVec3| pose.position_m() + pose.rotation() * point;
        let tip = DVec3::new(0.0, 0.0, 0.2);
        let error = place(&in_display, tip) - display_from_tracker.point(place(&in_tracker, tip));
        assert!(error.length() < 1e-15, "{error}");
    }
}
