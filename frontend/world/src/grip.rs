//! Hands that hold the volume: with one it moves as the hand does, with two it is scaled as well.

use crate::stage::Handling;
use crate::turn::{between, shortest_arc, twist};
use glam::{DQuat, DVec3};

/// Hands nearer than this to each other say nothing of size and direction, metres.
const TOGETHER_M: f64 = 0.01;

/// A hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// The tip of its tool, metres, display frame.
    pub tip_m: DVec3,
    /// From the tool's axes to the display's.
    pub rotation: DQuat,
}

/// A volume: where its centre is, how it is turned, and how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Its centre, metres, display frame.
    pub centre_m: DVec3,
    /// Its turn.
    pub turn: DQuat,
    /// Its size.
    pub scale: f64,
}

impl Body {
    /// A volume whose scene has its centre there.
    pub fn new(handling: Handling, home_m: DVec3) -> Self {
        Self { centre_m: home_m + handling.shift_m, turn: handling.turn, scale: handling.scale }
    }

    /// How it is handled.
    pub fn handling(&self, home_m: DVec3) -> Handling {
        Handling { turn: self.turn, shift_m: self.centre_m - home_m, scale: self.scale }
    }
}

/// Hands and volume as they were when the last of these hands closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// One hand.
    One(Hand, Body),
    /// Two.
    Two([Hand; 2], Body),
}

impl Grip {
    /// The volume now that the hand is here, of sizes within `scales`.
    pub fn moved_by_one(began: &Hand, body: &Body, now: &Hand) -> Body {
        let turned = now.rotation * began.rotation.inverse();
        Body {
            centre_m: now.tip_m + turned * (body.centre_m - began.tip_m),
            turn: (turned * body.turn).normalize(),
            scale: body.scale,
        }
    }

    /// The same for two hands. What they held stays under them while its size may follow: the line between the hands turns
    /// it, and about that line the mean of how each hand turns.
    pub fn moved_by_two(began: &[Hand; 2], body: &Body, now: &[Hand; 2], scales: (f64, f64)) -> Body {
        let line = |hands: &[Hand; 2]| hands[1].tip_m - hands[0].tip_m;
        let middle = |hands: &[Hand; 2]| 0.5 * (hands[0].tip_m + hands[1].tip_m);
        let (before, after) = (line(began), line(now));
        let (apart, is_apart) = (before.length(), before.length().min(after.length()) > TOGETHER_M);
        let turned = if is_apart {
            let axis = after / after.length();
            let arc = shortest_arc(before / apart, axis);
            let own = |i: usize| now[i].rotation * began[i].rotation.inverse() * arc.inverse();
            between(twist(own(0), axis), twist(own(1), axis), 0.5) * arc
        } else {
            DQuat::IDENTITY
        };
        let grown = if is_apart { after.length() / apart } else { 1.0 };
        let scale = (body.scale * grown).clamp(scales.0, scales.1);
        Body {
            centre_m: middle(now) + scale / body.scale * (turned * (body.centre_m - middle(began))),
            turn: (turned * body.turn).normalize(),
            scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of lengths of a metre.
    const ROUNDING_M: f64 = 1e-12;
    const SCALES: (f64, f64) = (1e-3, 1e3);

    fn hand(x: f64, y: f64, z: f64, turn: DQuat) -> Hand {
        Hand { tip_m: DVec3::new(x, y, z), rotation: turn }
    }

    fn body() -> Body {
        Body { centre_m: DVec3::new(0.0, 0.05, -0.1), turn: DQuat::from_rotation_z(0.2), scale: 1.3 }
    }

    /// Where a point of the volume is: a place in its own frame at unit size.
    fn place(body: &Body, own: DVec3) -> DVec3 {
        body.centre_m + body.scale * (body.turn * own)
    }

    fn own(body: &Body, place: DVec3) -> DVec3 {
        body.turn.inverse() * (place - body.centre_m) / body.scale
    }

    #[test]
    fn the_volume_stays_where_it_was_as_the_tool_sees_it() {
        let began = hand(0.1, -0.2, 0.4, DQuat::from_rotation_x(0.3));
        let now = hand(-0.3, 0.1, 0.6, DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(-0.4));
        let same = Grip::moved_by_one(&began, &body(), &began);
        assert!(same.centre_m.distance(body().centre_m) < ROUNDING_M);
        let moved = Grip::moved_by_one(&began, &body(), &now);
        let seen = |hand: &Hand, point: DVec3| hand.rotation.inverse() * (point - hand.tip_m);
        for point in [DVec3::ZERO, DVec3::X, DVec3::new(0.3, -0.2, 0.7)] {
            let (before, after) = (place(&body(), point), place(&moved, point));
            assert!(seen(&now, after).distance(seen(&began, before)) < ROUNDING_M);
        }
    }

    #[test]
    fn what_two_hands_hold_stays_under_them() {
        let began =
            [hand(-0.2, 0.0, 0.3, DQuat::IDENTITY), hand(0.1, 0.05, 0.35, DQuat::from_rotation_x(0.1))];
        let turn = DQuat::from_rotation_y(0.8);
        let now = [hand(0.0, 0.3, 0.2, turn), hand(0.15, -0.3, 0.5, turn * DQuat::from_rotation_z(0.4))];
        let moved = Grip::moved_by_two(&began, &body(), &now, SCALES);
        for i in 0..2 {
            let held = own(&body(), began[i].tip_m);
            assert!(place(&moved, held).distance(now[i].tip_m) < ROUNDING_M, "hand {i}");
        }
        let grown = now[0].tip_m.distance(now[1].tip_m) / began[0].tip_m.distance(began[1].tip_m);
        assert!((moved.scale / body().scale - grown).abs() < 1e-12);
    }

    #[test]
    fn hands_that_turn_about_the_line_between_them_turn_the_volume() {
        let began = [hand(-0.2, 0.0, 0.3, DQuat::IDENTITY), hand(0.2, 0.0, 0.3, DQuat::IDENTITY)];
        let turned = [0.2, 0.6].map(DQuat::from_rotation_x);
        let now = [hand(-0.2, 0.0, 0.3, turned[0]), hand(0.2, 0.0, 0.3, turned[1])];
        let moved = Grip::moved_by_two(&began, &body(), &now, SCALES);
        let mean = DQuat::from_rotation_x(0.4) * body().turn;
        assert!(moved.turn.abs_diff_eq(mean, 1e-9), "{moved:?}");
    }

    #[test]
    fn hands_that_meet_and_sizes_at_their_limit_keep_all_finite() {
        let began = [hand(-0.2, 0.0, 0.3, DQuat::IDENTITY), hand(0.2, 0.0, 0.3, DQuat::IDENTITY)];
        let met = [hand(0.0, 0.0, 0.3, DQuat::IDENTITY); 2];
        for (began, now) in [(began, met), (met, began), (met, met)] {
            let moved = Grip::moved_by_two(&began, &body(), &now, SCALES);
            assert!(moved.centre_m.is_finite() && moved.turn.is_finite() && moved.scale == body().scale);
        }
        let far = [hand(-9.0, 0.0, 0.3, DQuat::IDENTITY), hand(9.0, 0.0, 0.3, DQuat::IDENTITY)];
        assert_eq!(Grip::moved_by_two(&began, &body(), &far, (0.5, 2.0)).scale, 2.0);
    }
}
