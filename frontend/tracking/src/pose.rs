//! Where a tracked body is, and how it is turned.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Coordinates beyond this are nonsense, metres: what is computed from poses stays finite.
pub const FARTHEST_M: f64 = 1e6;
/// Quaternions that are shorter have no direction, and longer ones overflow.
const QUATERNION_LENGTHS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// A position and a rotation, always finite. The rotation is of unit length, and q and −q make the same pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Pose {
    position_m: DVec3,
    rotation: DQuat,
}

/// A pose that somebody wrote down.
#[derive(Deserialize)]
struct Unchecked {
    position_m: DVec3,
    rotation: DQuat,
}

impl TryFrom<Unchecked> for Pose {
    type Error = &'static str;

    fn try_from(unchecked: Unchecked) -> Result<Self, Self::Error> {
        Self::new(unchecked.position_m, unchecked.rotation)
            .ok_or("a pose has a finite place within 1000 km, and a quaternion with a direction")
    }
}

impl Pose {
    /// The pose of a body whose origin is at `position_m`, metres, and whose axes `rotation` turns into those of the frame;
    /// its length does not matter. None where a coordinate is NaN, infinite or farther than 1000 km, or the quaternion has
    /// no direction: trackers send such poses for a lost target.
    pub fn new(position_m: DVec3, rotation: DQuat) -> Option<Self> {
        // NaN is within no range.
        let is_near = position_m.to_array().iter().all(|c| (-FARTHEST_M..=FARTHEST_M).contains(c));
        let has_direction = QUATERNION_LENGTHS.contains(&rotation.length());
        (is_near && has_direction).then(|| Self { position_m, rotation: canonical(unit(rotation)) })
    }

    /// Its origin, metres.
    pub fn position_m(&self) -> DVec3 {
        self.position_m
    }

    /// From the body's axes to the frame's, of unit length.
    pub fn rotation(&self) -> DQuat {
        self.rotation
    }
}

/// Of unit length. One that already is stays as it is, to the bit: a pose made of another one's parts is the same pose.
fn unit(rotation: DQuat) -> DQuat {
    let is_unit = (rotation.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON;
    if is_unit { rotation } else { rotation.normalize() }
}

/// The one of q and −q whose last component that is not 0 is positive.
fn canonical(rotation: DQuat) -> DQuat {
    let [x, y, z, w] = rotation.to_array();
    let sign = [w, z, y, x].into_iter().find(|&component| component != 0.0).unwrap_or(1.0);
    if sign < 0.0 { -rotation } else { rotation }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lost_targets_are_no_poses() {
        let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        for (position_m, rotation) in [
            (DVec3::new(f64::NAN, 0.0, 0.0), DQuat::IDENTITY),
            (DVec3::new(0.0, f64::INFINITY, 0.0), DQuat::IDENTITY),
            (DVec3::new(0.0, 0.0, -1.1e6), DQuat::IDENTITY),
            (DVec3::ZERO, zero),
            (DVec3::ZERO, DQuat::from_xyzw(0.0, f64::NAN, 0.0, 1.0)),
            (DVec3::ZERO, DQuat::from_xyzw(0.0, f64::MAX, 0.0, 1.0)),
            (DVec3::ZERO, DQuat::from_xyzw(1e-9, 0.0, 0.0, 0.0)),
        ] {
            assert_eq!(Pose::new(position_m, rotation), None, "{position_m} {rotation}");
        }
        assert!(Pose::new(DVec3::splat(1e6), DQuat::from_xyzw(0.0, 0.0, 0.0, 1e5)).is_some());
    }

    #[test]
    fn the_parts_of_a_pose_make_the_same_pose() {
        for n in 0..1000 {
            let pose =
                Pose::new(DVec3::X, DQuat::from_xyzw(0.1, 0.2, 0.3, 0.1 + 0.01 * f64::from(n))).unwrap();
            assert_eq!(Pose::new(pose.position_m(), pose.rotation()), Some(pose));
        }
    }

    #[test]
    fn both_signs_of_a_quaternion_are_one_pose() {
        for rotation in [
            DQuat::from_xyzw(0.1, 0.2, 0.3, 0.4),
            DQuat::from_xyzw(0.1, -0.2, -0.3, 0.0),
            DQuat::from_xyzw(-1.0, 0.0, 0.0, 0.0),
        ] {
            assert_eq!(Pose::new(DVec3::X, rotation), Pose::new(DVec3::X, -rotation), "{rotation}");
        }
    }

    #[test]
    fn a_pose_comes_back_from_a_tape_and_what_is_none_does_not() {
        let turn = DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize();
        let pose = Pose::new(DVec3::new(1.0, -2.0, 3.0), turn).unwrap();
        let text = serde_json::to_string(&pose).unwrap();
        assert_eq!(serde_json::from_str::<Pose>(&text).unwrap(), pose);
        let spoiled = r#"{"position_m":[1,2,3],"rotation":[0,0,0,0]}"#;
        assert!(serde_json::from_str::<Pose>(spoiled).is_err());
    }
}
