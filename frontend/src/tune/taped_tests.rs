//! Laws of the tapes that come with the program: they play, and visitors do on them what their names say.

use super::*;
use crate::scene::{LookName, Scene, VolumeFacts, read_values};
use crate::staging::Looks;
use crate::tune::RATE_HZ;
use bricks::procedural::ProceduralVolume;
use glam::UVec3;
use optics::Enhancer;

/// Frames of each tape.
const FRAMES: [usize; 2] = [600, 630];
/// The least share of what they show that rests: on the tape of a cut nothing is held for the first 0.6 s and the last second, and a
/// tool in a hand is never quite still. And the least that moves.
const SHARES: (f64, f64) = (0.15, 0.2);

fn piece() -> Piece {
    let scene = Scene::load("procedural:shells@32").unwrap();
    let volume = ProceduralVolume::new("shells", UVec3::splat(32), 1e-3).unwrap();
    let names = vec![LookName::Scalar, LookName::Fluorescence];
    let looks = Looks { values: Some(read_values(&volume)), names, shown: None };
    Piece::new(scene, VolumeFacts::of(&volume), &looks)
}

fn states(place: usize) -> Vec<FrameState> {
    let (name, bytes) = SHIPPED[place];
    let (display, tape) = (Display::load("desk8").unwrap(), open_shipped(name, bytes).unwrap());
    let (scenario, news) = recorded(tape, name, piece(), &display).unwrap();
    assert_eq!(news, Vec::<String>::new());
    assert_eq!(scenario.name, format!("{}, {name}", piece().name()));
    scenario.states
}

/// The turn of the volume from the first state to another, degrees.
fn turn(states: &[FrameState], at_s: f64) -> f64 {
    let rotation = |state: &FrameState| state.display_from_volume.to_scale_rotation_translation().1;
    let at = (at_s * RATE_HZ) as usize;
    rotation(&states[0]).angle_between(rotation(&states[at])).to_degrees()
}

#[test]
fn they_rest_and_move() {
    for (place, frames) in FRAMES.into_iter().enumerate() {
        let states = states(place);
        assert_eq!(states.len(), frames, "{}", SHIPPED[place].0);
        let rests = states.windows(2).filter(|pair| pair[0].is_seen_as(&pair[1])).count() as f64;
        let rests = rests / states.len() as f64;
        assert!(rests > SHARES.0 && 1.0 - rests > SHARES.1, "{}: {rests} of it rests", SHIPPED[place].0);
    }
}

#[test]
fn a_hand_turns_the_volume_and_changes_its_look() {
    let states = states(0);
    let turns = [0.5, 2.7, 5.2, 9.8].map(|at_s| turn(&states, at_s));
    assert!(turns[0] < 0.1 && turns[1] > 60.0, "{turns:?}");
    assert!(turns[2] < turns[1] - 20.0 && (turns[3] - turns[2]).abs() > 10.0, "{turns:?}");
    let optics = |at_s: f64| &states[(at_s * RATE_HZ) as usize].optics;
    assert_eq!(optics(0.5), optics(5.4));
    assert_ne!(optics(5.4), optics(6.1), "the next look");
    assert_ne!(optics(6.1), optics(8.4), "other values");
}

#[test]
fn a_knife_cuts_what_another_hand_turns_and_becomes_a_light() {
    let states = states(1);
    let plane = |at_s: f64| {
        let enhancers = &states[(at_s * RATE_HZ) as usize].optics.enhancers;
        enhancers.iter().find_map(|enhancer| match enhancer {
            Enhancer::ClipPlane(plane) => Some(*plane),
            _ => None,
        })
    };
    assert_eq!(plane(0.4), None);
    let (before, inside, aslant) = (plane(0.8).unwrap(), plane(2.4).unwrap(), plane(4.6).unwrap());
    assert!(before.point_in_display.z > 0.3 && inside.point_in_display.z < 0.05, "{before:?}, {inside:?}");
    assert!(inside.normal_in_display.angle_between(aslant.normal_in_display).to_degrees() > 25.0);
    assert_eq!(plane(8.0), None);
    assert!(turn(&states, 4.6) < 0.1 && turn(&states, 6.3) > 40.0);
    let light = |at_s: f64| states[(at_s * RATE_HZ) as usize].light;
    assert_ne!(light(7.6), light(8.6));
    assert!(states[600].is_seen_as(&states[629]), "all is laid down");
}
