//! Where a tracked thing is, and how it is turned.

use crate::Refusal;
use glam::{DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// No tracker reaches farther, metres.
const FARTHEST_M: f64 = 1e6;
/// A quaternion is brought to length 1 if it is at most so many times too long or too short.
const LONGEST_QUATERNION: f64 = 2.0;
/// How far the products of a rotation matrix's columns may be from 0 and 1; DTrack prints six digits.
const SKEW: f64 = 1e-3;

/// A pose in a tracker's own frame: finite, with a quaternion of length 1. There is no other way to make one, also not from
/// a tape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Pose {
    position_m: DVec3,
    orientation: DQuat,
}

/// A pose that somebody wrote down.
#[derive(Deserialize)]
struct Unchecked {
    position_m: DVec3,
    orientation: DQuat,
}

impl TryFrom<Unchecked> for Pose {
    type Error = Refusal;

    fn try_from(unchecked: Unchecked) -> Result<Self, Refusal> {
        Self::new(unchecked.position_m, unchecked.orientation)
    }
}

impl Pose {
    /// A position in metres, and an orientation that is brought to length 1.
    ///
    /// # Errors
    /// Numbers that are not finite, a place farther than 1000 km, a quaternion that is not of length 1 or near it.
    pub fn new(position_m: DVec3, orientation: DQuat) -> Result<Self, Refusal> {
        if !position_m.is_finite() || !orientation.is_finite() {
            return Err(Refusal::NotFinite);
        }
        if position_m.abs().max_element() > FARTHEST_M {
            return Err(Refusal::TooFar);
        }
        let length = orientation.length();
        if !(1.0 / LONGEST_QUATERNION..=LONGEST_QUATERNION).contains(&length) {
            return Err(Refusal::NoQuaternion);
        }
        // A quaternion that is of length 1 to rounding stays as it is, so that what a tape keeps comes back bit by bit.
        let is_unit = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
        Ok(Self { position_m, orientation: if is_unit { orientation } else { orientation / length } })
    }

    /// A position in metres and a rotation matrix.
    ///
    /// # Errors
    /// Those of [`Pose::new`]; a matrix that is zero, skewed, scaled or mirrored.
    pub fn from_matrix(position_m: DVec3, rotation: DMat3) -> Result<Self, Refusal> {
        if !rotation.is_finite() {
            return Err(Refusal::NotFinite);
        }
        let is_orthonormal = (rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, SKEW);
        if !is_orthonormal || rotation.determinant() < 0.0 {
            return Err(Refusal::NoRotation);
        }
        Self::new(position_m, DQuat::from_mat3(&rotation))
    }

    /// In the tracker's own frame, metres.
    pub const fn position_m(&self) -> DVec3 {
        self.position_m
    }

    /// From the frame of the tracked thing to the tracker's own, of length 1.
    pub const fn orientation(&self) -> DQuat {
        self.orientation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_pose_is_refused() {
        let refused = |position: DVec3, turn: DQuat| Pose::new(position, turn).unwrap_err();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(refused(DVec3::new(0.0, bad, 0.0), DQuat::IDENTITY), Refusal::NotFinite);
            assert_eq!(refused(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, bad, 1.0)), Refusal::NotFinite);
        }
        assert_eq!(refused(DVec3::new(0.0, 0.0, 1e7), DQuat::IDENTITY), Refusal::TooFar);
        for length in [0.0, 1e-9, 0.49, 2.01, 1e300] {
            let turn = DQuat::from_xyzw(0.0, 0.0, 0.0, length);
            assert_eq!(refused(DVec3::ZERO, turn), Refusal::NoQuaternion, "{length}");
        }
    }

    #[test]
    fn matrices_that_are_no_rotation_are_refused() {
        let mirrored = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        let skewed = DMat3::from_cols(DVec3::X, DVec3::new(0.1, 0.99, 0.0), DVec3::Z);
        for matrix in [DMat3::ZERO, mirrored, skewed, DMat3::IDENTITY * 1.1] {
            assert_eq!(Pose::from_matrix(DVec3::ZERO, matrix).unwrap_err(), Refusal::NoRotation);
        }
        let nan = DMat3::from_diagonal(DVec3::splat(f64::NAN));
        assert_eq!(Pose::from_matrix(DVec3::ZERO, nan).unwrap_err(), Refusal::NotFinite);
        assert!(Pose::from_matrix(DVec3::ZERO, DMat3::from_rotation_y(0.3)).is_ok(), "the canary");
    }

    #[test]
    fn a_pose_comes_back_from_a_tape_and_what_is_none_does_not() {
        let turn = DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize();
        let pose = Pose::new(DVec3::new(1.0, -2.0, 3.0), turn).unwrap();
        let text = serde_json::to_string(&pose).unwrap();
        assert_eq!(serde_json::from_str::<Pose>(&text).unwrap(), pose);
        let spoiled = r#"{"position_m":[1,2,3],"orientation":[0,0,0,0]}"#;
        assert!(serde_json::from_str::<Pose>(spoiled).is_err());
    }
}
