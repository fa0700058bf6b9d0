//! Rotations, built so that they come out the same on every machine: the trigonometry of C libraries does not.

use glam::{DQuat, DVec3};

/// Vectors shorter than this have no direction, and quaternions none to turn about.
const NO_LENGTH: f64 = 1e-12;

/// A turn about the upright axis, radians: the front goes to the right.
pub fn about_y(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// A turn about the level axis, radians: the front goes down.
pub fn about_x(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// The shortest turn from one unit vector to another.
pub fn shortest_arc(from: DVec3, to: DVec3) -> DQuat {
    let (axis, w) = (from.cross(to), 1.0 + from.dot(to));
    let turn = DQuat::from_xyzw(axis.x, axis.y, axis.z, w);
    if turn.length_squared() > NO_LENGTH * NO_LENGTH {
        return turn.normalize();
    }
    // Opposite: half a turn about anything that is perpendicular.
    let across = from.any_orthonormal_vector();
    DQuat::from_xyzw(across.x, across.y, across.z, 0.0)
}

/// The part of a turn that is about a unit axis.
pub fn twist(turn: DQuat, axis: DVec3) -> DQuat {
    let along = axis * axis.dot(DVec3::new(turn.x, turn.y, turn.z));
    let about = DQuat::from_xyzw(along.x, along.y, along.z, turn.w);
    if about.length_squared() > NO_LENGTH * NO_LENGTH { about.normalize() } else { DQuat::IDENTITY }
}

/// From one turn to another by a share, along the shorter way.
pub fn between(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let to = if from.dot(to) < 0.0 { -to } else { to };
    let mixed = from * (1.0 - share) + to * share;
    if mixed.length_squared() > NO_LENGTH { mixed.normalize() } else { to }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few operations.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn they_are_the_turns_that_they_say() {
        for angle in [-3.0, -0.1, 0.0, 1e-9, 0.7, 2.9] {
            assert!(about_y(angle).abs_diff_eq(DQuat::from_rotation_y(angle), ROUNDING), "{angle}");
            assert!(about_x(angle).abs_diff_eq(DQuat::from_rotation_x(angle), ROUNDING), "{angle}");
        }
    }

    #[test]
    fn an_arc_leads_from_one_direction_to_the_other_also_where_they_are_opposite() {
        let a = DVec3::new(0.6, -0.64, 0.48);
        for b in [a, -a, DVec3::X, DVec3::NEG_Z, a.any_orthonormal_vector()] {
            let arc = shortest_arc(a, b);
            assert!((arc * a - b).length() < 4.0 * ROUNDING && (arc.length() - 1.0).abs() < ROUNDING, "{b}");
        }
    }

    #[test]
    fn a_twist_keeps_what_is_about_the_axis() {
        let axis = DVec3::new(0.6, -0.64, 0.48);
        let about = DQuat::from_axis_angle(axis, 0.8);
        assert!(twist(about, axis).abs_diff_eq(about, ROUNDING));
        let across = DQuat::from_axis_angle(axis.any_orthonormal_vector(), 0.5);
        assert!(twist(across, axis).abs_diff_eq(DQuat::IDENTITY, ROUNDING));
        assert_eq!(twist(DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), DVec3::Z), DQuat::IDENTITY);
    }

    #[test]
    fn half_way_goes_the_shorter_way() {
        let (a, b) = (about_y(0.2), -about_y(0.6));
        assert!(between(a, b, 0.5).abs_diff_eq(about_y(0.4), ROUNDING));
        assert!(between(a, b, 0.0).abs_diff_eq(a, ROUNDING));
    }
}
