//! Rotations as vectors along their axis, as long as their angle in radians.

use glam::{DQuat, DVec3};

/// The shortest turn that takes one rotation to another, in the frame's axes: a vector of at most π.
pub(crate) fn turn_between(from: DQuat, to: DQuat) -> DVec3 {
    // The product of `to` and the conjugate of `from`, in an order that leaves 0 to the bit if they are the same.
    let (v, v0) = (to.xyz(), from.xyz());
    let (vector, w) = (from.w * v - to.w * v0 - v.cross(v0), to.dot(from));
    let (vector, w) = if w < 0.0 { (-vector, -w) } else { (vector, w) };
    let sine = vector.length();
    // atan2(s, w) / s goes to 1 / w as s goes to 0.
    let half_angle_per_sine = if sine > f64::MIN_POSITIVE { sine.atan2(w) / sine } else { 1.0 };
    2.0 * half_angle_per_sine * vector
}

/// A rotation that goes a share of the way to another, on the shortest arc at an even pace (slerp, Shoemake 1985). No way
/// leaves it as it is, to the bit.
pub(crate) fn turned_toward(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let turn = share * turn_between(from, to);
    if turn == DVec3::ZERO { from } else { (DQuat::from_scaled_axis(turn) * from).normalize() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUNDING: f64 = 1e-14;

    #[test]
    fn a_turn_is_the_vector_that_makes_it() {
        for angle in [0.0, 1e-300, 1e-12, 0.3, 3.0, std::f64::consts::PI] {
            let turn = angle * DVec3::new(2.0, -1.0, 2.0) / 3.0;
            let rotation = DQuat::from_scaled_axis(turn);
            for to in [rotation, -rotation] {
                assert!(turn_between(DQuat::IDENTITY, to).distance(turn) <= ROUNDING, "{angle}");
            }
        }
    }

    #[test]
    fn a_share_of_a_turn_is_made() {
        let (from, turn) = (DQuat::from_rotation_x(0.4), DVec3::new(0.3, 1.0, -0.2));
        let to = DQuat::from_scaled_axis(turn) * from;
        for to in [to, -to] {
            let made = turn_between(from, turned_toward(from, to, 0.25));
            assert!(made.distance(0.25 * turn) < ROUNDING, "{made}");
        }
        let odd = DQuat::from_xyzw(0.1, 0.2, 0.3, 0.4).normalize();
        assert_eq!(turned_toward(odd, odd, 0.3), odd);
        assert_eq!(turned_toward(odd, -odd, 0.3), odd);
    }
}
