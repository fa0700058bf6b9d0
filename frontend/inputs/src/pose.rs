//! From the numbers of a message to a pose.

use crate::Refusal;
use glam::{DMat3, DQuat, DVec3};
use tracking::{FARTHEST_M, Pose};

/// A quaternion is brought to length 1 if it is at most so many times too long or too short.
const LONGEST_QUATERNION: f64 = 2.0;
/// How far the products of a rotation matrix's columns may be from 0 and 1; DTrack prints six digits.
const SKEW: f64 = 1e-3;

/// The pose at a position, metres, in the tracker's own frame, with the quaternion that takes directions of the tracked thing
/// to that frame; it is brought to length 1.
///
/// # Errors
/// Numbers that are not finite, a place farther than 1000 km, a quaternion that is not of length 1 or near it.
pub(crate) fn checked_pose(position_m: DVec3, rotation: DQuat) -> Result<Pose, Refusal> {
    if !position_m.is_finite() || !rotation.is_finite() {
        return Err(Refusal::NotFinite);
    }
    if position_m.abs().max_element() > FARTHEST_M {
        return Err(Refusal::TooFar);
    }
    let is_near_unit = (1.0 / LONGEST_QUATERNION..=LONGEST_QUATERNION).contains(&rotation.length());
    Pose::new(position_m, rotation).filter(|_| is_near_unit).ok_or(Refusal::NoQuaternion)
}

/// The same with a rotation matrix.
///
/// # Errors
/// Those of [`checked_pose`]; a matrix that is zero, skewed, scaled or mirrored.
pub(crate) fn pose_of_matrix(position_m: DVec3, rotation: DMat3) -> Result<Pose, Refusal> {
    if !rotation.is_finite() {
        return Err(Refusal::NotFinite);
    }
    let is_orthonormal = (rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, SKEW);
    if !is_orthonormal || rotation.determinant() < 0.0 {
        return Err(Refusal::NoRotation);
    }
    checked_pose(position_m, DQuat::from_mat3(&rotation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_pose_is_refused() {
        let refused = |position: DVec3, turn: DQuat| checked_pose(position, turn).unwrap_err();
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
            assert_eq!(pose_of_matrix(DVec3::ZERO, matrix).unwrap_err(), Refusal::NoRotation);
        }
        let nan = DMat3::from_diagonal(DVec3::splat(f64::NAN));
        assert_eq!(pose_of_matrix(DVec3::ZERO, nan).unwrap_err(), Refusal::NotFinite);
        assert!(pose_of_matrix(DVec3::ZERO, DMat3::from_rotation_y(0.3)).is_ok(), "the canary");
    }
}
