//! An interaction: what rays see at each sixtieth of a second.

use crate::scene::usual_enhancer;
use glam::{DAffine3, DQuat, DVec3};
use optics::{Curve, Enhancer, EnhancerKind, Optics};
use protocol::FrameState;

/// Instants per second.
pub const RATE_HZ: f64 = 60.0;

/// How a scene moves that has no tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Its volume is turned.
    Turn,
    /// Its volume becomes denser and fainter.
    Look,
    /// A clip plane is moved through it.
    Clip,
}

/// Each rests, goes fast, rests, goes slowly, jumps back, and rests: (seconds, share of the way).
const COURSE: [(f64, f64); 8] =
    [(0.0, 0.0), (0.4, 0.0), (1.2, 0.8), (1.8, 0.8), (2.8, 1.0), (3.0, 1.0), (3.0, 0.5), (4.0, 0.5)];
/// The whole way of a turn, radians; of a look, doublings of the extinction; of a plane, shares of the screen's height.
const TURN: f64 = std::f64::consts::FRAC_PI_2;
const DOUBLINGS: f64 = 1.5;
const SWEEP: f64 = 0.6;

/// An interaction.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// What it is called.
    pub name: String,
    /// What rays see at each instant.
    pub states: Vec<FrameState>,
}

impl Scenario {
    /// Of states at any times, each seen until the next.
    pub fn sampled(name: String, states: impl Iterator<Item = FrameState>) -> Self {
        let mut sampled: Vec<FrameState> = Vec::new();
        let mut began_s = None;
        for state in states {
            let instant =
                ((state.time_s - *began_s.get_or_insert(state.time_s)) * RATE_HZ).round().max(0.0) as usize;
            // What was seen before lasts until now.
            while let Some(last) = sampled.last().filter(|_| sampled.len() < instant).cloned() {
                sampled.push(last);
            }
            sampled.truncate(instant);
            sampled.push(state);
        }
        Self { name, states: sampled }
    }
}

impl Motion {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Turn => "turned",
            Self::Look => "its extinction changed",
            Self::Clip => "cut by a plane",
        }
    }

    /// A scene, which stands still in `frame`, moved on a screen of such a height, metres.
    pub fn scenario(self, scene: &str, frame: &FrameState, screen_m: f64) -> Scenario {
        let instants = (COURSE[COURSE.len() - 1].0 * RATE_HZ) as u32;
        let state = |instant: u32| {
            let time_s = f64::from(instant) / RATE_HZ;
            FrameState { index: instant, time_s, ..self.moved(frame, way_at(time_s), screen_m) }
        };
        Scenario { name: format!("{scene}, {}", self.name()), states: (0..instants).map(state).collect() }
    }

    fn moved(self, frame: &FrameState, way: f64, screen_m: f64) -> FrameState {
        match self {
            Self::Turn => {
                let turn = DAffine3::from_quat(DQuat::from_rotation_y(TURN * way));
                FrameState { display_from_volume: turn * frame.display_from_volume, ..frame.clone() }
            }
            Self::Look => {
                let factor = (DOUBLINGS * (way - 0.5)).exp2();
                let points = frame.optics.extinction.points();
                let scaled = Curve::new(points.iter().map(|&(s, tau)| (s, factor * tau)).collect());
                let extinction = scaled.unwrap_or_else(|_| frame.optics.extinction.clone());
                FrameState { optics: Optics { extinction, ..frame.optics.clone() }, ..frame.clone() }
            }
            Self::Clip => {
                let mut frame = frame.clone();
                if let Some(Enhancer::ClipPlane(mut plane)) = usual_enhancer(EnhancerKind::ClipPlane, None) {
                    plane.normal_in_display = DVec3::new(0.3, 0.2, 1.0).normalize();
                    plane.point_in_display = DVec3::new(0.0, 0.0, SWEEP * screen_m * (0.5 - way));
                    frame.optics.enhancers.insert(0, Enhancer::ClipPlane(plane));
                }
                frame
            }
        }
    }
}

/// The share of the way at a time, seconds.
fn way_at(time_s: f64) -> f64 {
    let after = COURSE.iter().rposition(|&(begin, _)| begin <= time_s).unwrap_or(0);
    let (begin, from) = COURSE[after];
    let Some(&(end, to)) = COURSE.get(after + 1) else { return from };
    if end > begin { from + (to - from) * (time_s - begin) / (end - begin) } else { to }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_rests_goes_and_jumps() {
        assert_eq!([0.0, 0.3, 1.5, 3.5].map(way_at), [0.0, 0.0, 0.8, 0.5]);
        assert!((way_at(0.8) - 0.4).abs() < 1e-12);
        assert!(way_at(2.9) == 1.0 && way_at(3.0) == 0.5);
    }

    #[test]
    fn states_last_until_the_next() {
        let frame = FrameState::still(DVec3::Z, DAffine3::IDENTITY, Optics::grey(Curve::constant(1.0)));
        let at = |time_s: f64| FrameState { time_s, ..frame.clone() };
        let sampled = Scenario::sampled("a".to_owned(), [5.0, 5.05, 5.051, 5.1].map(at).into_iter());
        let times: Vec<f64> = sampled.states.iter().map(|state| state.time_s).collect();
        assert_eq!(times, [5.0, 5.0, 5.0, 5.051, 5.051, 5.051, 5.1]);
    }

    #[test]
    fn every_motion_moves_and_comes_to_rest() {
        let frame = FrameState::still(DVec3::Z, DAffine3::IDENTITY, Optics::grey(Curve::constant(1.0)));
        for motion in [Motion::Turn, Motion::Look, Motion::Clip] {
            let states = motion.scenario("a", &frame, 0.3).states;
            assert_eq!(states.len(), 240);
            let seen = |at: usize| FrameState { index: 0, time_s: 0.0, ..states[at].clone() };
            assert_eq!(seen(0), seen(20));
            assert_ne!(seen(30), seen(31));
            assert_eq!(seen(200), seen(239));
        }
    }
}
