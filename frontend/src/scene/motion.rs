//! What moves, and how.

use glam::{DQuat, DVec3};

/// Something that can be interpolated between two of its values.
pub trait Tween: Copy {
    /// From `self` at share 0 to `to` at share 1.
    fn tween(self, to: Self, share: f64) -> Self;
}

impl Tween for DVec3 {
    fn tween(self, to: Self, share: f64) -> Self {
        self.lerp(to, share)
    }
}

impl Tween for DQuat {
    /// The shortest way round: two keyframes never span more than half a turn.
    fn tween(self, to: Self, share: f64) -> Self {
        self.slerp(to, share)
    }
}

/// A unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(pub DVec3);

impl Tween for Direction {
    /// Along the great circle; between opposite directions along one of them.
    fn tween(self, to: Self, share: f64) -> Self {
        let arc = DQuat::from_rotation_arc(self.0, to.0);
        Self((DQuat::IDENTITY.slerp(arc, share) * self.0).normalize())
    }
}

/// Values of one thing at rising times, seconds: linear between them, constant before and after.
#[derive(Clone, Debug, PartialEq)]
pub struct Track<T> {
    keys: Vec<(f64, T)>,
}

impl<T> Default for Track<T> {
    fn default() -> Self {
        Self { keys: Vec::new() }
    }
}

impl<T: Tween> Track<T> {
    /// Adds a key later than all before it.
    pub fn push(&mut self, time_s: f64, value: T) {
        debug_assert!(self.keys.last().is_none_or(|key| key.0 < time_s));
        self.keys.push((time_s, value));
    }

    /// The value at a time; None if there are no keys.
    pub fn at(&self, time_s: f64) -> Option<T> {
        let after = self.keys.partition_point(|key| key.0 <= time_s);
        match (after.checked_sub(1).and_then(|i| self.keys.get(i)), self.keys.get(after)) {
            (Some(&(t0, a)), Some(&(t1, b))) => Some(a.tween(b, (time_s - t0) / (t1 - t0))),
            (Some(&(_, only)), None) | (None, Some(&(_, only))) => Some(only),
            (None, None) => None,
        }
    }
}

/// The tracks of a scene; an empty one leaves its subject where the scene puts it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// The virtual observer, metres.
    pub observer_m: Track<DVec3>,
    /// The volume's centre, metres.
    pub centre_m: Track<DVec3>,
    /// The volume's turn.
    pub rotation: Track<DQuat>,
    /// The tool's tip, metres.
    pub tool_tip_m: Track<DVec3>,
    /// Where the tool points.
    pub tool_axis: Track<Direction>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track<T: Tween>(keys: &[(f64, T)]) -> Track<T> {
        let mut track = Track::default();
        keys.iter().for_each(|&(t, v)| track.push(t, v));
        track
    }

    #[test]
    fn is_linear_between_keys_and_constant_beyond() {
        let track = track(&[(1.0, DVec3::ZERO), (3.0, DVec3::X)]);
        assert_eq!(track.at(0.0), Some(DVec3::ZERO));
        assert_eq!(track.at(2.5), Some(DVec3::new(0.75, 0.0, 0.0)));
        assert_eq!(track.at(9.0), Some(DVec3::X));
        assert_eq!(Track::<DVec3>::default().at(1.0), None);
    }

    #[test]
    fn rotations_take_the_short_way() {
        let turn = |deg: f64| DQuat::from_rotation_y(deg.to_radians());
        let track = track(&[(0.0, turn(350.0)), (1.0, turn(10.0))]);
        let half = track.at(0.5).unwrap() * DVec3::Z;
        assert!((half - DVec3::Z).length() < 1e-12, "{half}");
    }

    #[test]
    fn directions_stay_unit_vectors_even_between_opposites() {
        let track = track(&[(0.0, Direction(DVec3::Z)), (1.0, Direction(DVec3::NEG_Z))]);
        let half = track.at(0.5).unwrap().0;
        assert!((half.length() - 1.0).abs() < 1e-12 && half.z.abs() < 1e-12, "{half}");
    }
}
