//! Laws of a theatre.

use super::*;
use crate::drive::one_hand;
use crate::scene::{Scene, VolumeFacts, read_values};
use crate::staging::{Looks, check_number};
use bricks::procedural::ProceduralVolume;
use glam::{DQuat, UVec3};
use inputs::{Event, Pose, SourceId, What};
use proptest::prelude::*;
use protocol::{Mark, MarkShape, Paint};
use world::{Change, ToolKind};

const PACE: Pace = Pace::Live { upload_bytes: 1 << 20, fade_s: 0.0 };

fn piece_of(text: &str) -> Piece {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let scene = Scene::load(&path.to_string_lossy()).unwrap();
    let volume = ProceduralVolume::new("shells", UVec3::splat(32), 1e-3).unwrap();
    let names = vec![LookName::Scalar, LookName::Fluorescence];
    let looks = Looks { values: Some(read_values(&volume)), names, shown: None };
    Piece::new(scene, VolumeFacts::of(&volume), &looks)
}

fn theatre_of(text: &str) -> Theatre {
    Theatre::of_one(piece_of(text), one_hand(), Display::load("desk8").unwrap(), PACE)
}

fn still() -> Theatre {
    theatre_of("[volume]\nsource = 'procedural:shells@32'\n")
}

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn moment(ms: u64) -> Moment {
    let now = Duration::from_millis(ms);
    Moment { now, seen_at: now }
}

/// A frame, but for its number and time.
fn seen(theatre: &mut Theatre, at_ms: u64) -> FrameState {
    FrameState { time_s: 0.0, sub_frame: None, ..theatre.frame(0, moment(at_ms)).unwrap() }
}

fn change(change: Change) -> Deed {
    Deed::Change(change)
}

fn pose(at_ms: u64, position_m: DVec3, rotation: DQuat) -> Deed {
    let pose = Pose::new(position_m, rotation);
    let what = What::Pose { sensor: 0, pose };
    Deed::Event(Event { source: SourceId(0), device_time: None, received: ms(at_ms), what })
}

#[test]
fn what_is_handled_and_reset_is_as_it_was() {
    let mut theatre = still();
    let before = seen(&mut theatre, 0);
    let changes = [
        Change::Turn { right: 0.3, down: -0.2 },
        Change::Move(DVec3::new(0.1, 0.0, 0.05)),
        Change::Scale(1.5),
        Change::Clip,
        Change::NextLook,
    ];
    for (one, i) in changes.into_iter().zip(1..) {
        let earlier = seen(&mut theatre, 100 * i);
        theatre.apply(&change(one));
        assert_ne!(seen(&mut theatre, 100 * i + 50), earlier, "{one:?} shows");
    }
    theatre.apply(&change(Change::Reset));
    let after = (0..40).map(|i| seen(&mut theatre, 1000 + 50 * i)).last();
    assert_eq!(after, Some(before));
}

#[test]
fn what_a_tool_carries_goes_with_it_and_fades_with_it() {
    let mut theatre = theatre_of(
        "[volume]\nsource = 'procedural:shells@32'\n[tool]\nkind = 'pointer'\n\
         [[enhancer]]\nkind = 'clip-plane'\ncarried = true\n",
    );
    let plane = |theatre: &mut Theatre, at_ms| match seen(theatre, at_ms).optics.enhancers[..] {
        [Enhancer::ClipPlane(plane)] => plane,
        ref others => panic!("{others:?}"),
    };
    let scripted = plane(&mut theatre, 0);
    let (tip_m, rotation) = (DVec3::new(0.1, -0.05, 0.2), DQuat::from_rotation_y(0.5));
    for at_ms in (0..=500).step_by(10) {
        theatre.apply(&pose(at_ms, tip_m, rotation));
    }
    let held = plane(&mut theatre, 500);
    assert!(held.point_in_display.distance(tip_m) < 1e-9, "{held:?}");
    assert_eq!(held.strength, scripted.strength, "all of it is there");
    // It points along -z of its own; the plane faces back along it.
    assert!(held.normal_in_display.distance(rotation * DVec3::Z) < 1e-9, "{held:?}");
    let fading = plane(&mut theatre, 1100).strength;
    assert!(fading > 0.0 && fading < scripted.strength, "{fading}");
    let gone = plane(&mut theatre, 2000);
    assert_eq!((gone.strength, gone.point_in_display), (0.0, held.point_in_display));
}

const SCRIPT: &str = "[volume]\nsource = 'procedural:shells@32'\n[frames]\ncount = 61\nrate_hz = 60\n\
    [[keyframe]]\ntime_s = 0\ncentre_m = [0, 0, 0]\n[[keyframe]]\ntime_s = 1\ncentre_m = [0.2, 0, 0]\n";

#[test]
fn a_script_runs_by_the_time_frames_are_seen_and_stands_still_while_paused() {
    let mut theatre = theatre_of(SCRIPT);
    let x = |theatre: &mut Theatre, at: u64| {
        let frame = theatre.frame(0, moment(at)).unwrap();
        frame.display_from_volume.transform_point3(DVec3::splat(16.0)).x
    };
    assert!(x(&mut theatre, 5000).abs() < 1e-12, "it begins when the first frame is seen");
    assert!((x(&mut theatre, 5500) - 0.1).abs() < 1e-12);
    theatre.apply(&change(Change::Pause));
    assert!((x(&mut theatre, 9000) - 0.1).abs() < 1e-12);
    assert!(!theatre.is_over());
    theatre.apply(&change(Change::Pause));
    assert!((x(&mut theatre, 9500) - 0.2).abs() < 1e-12);
    assert!(theatre.is_over());
    assert!(!still().is_over());
}

#[test]
fn frames_go_through_the_sub_frames_or_cast_all() {
    let mut theatre = still();
    let cast: Vec<_> = (0..5).map(|i| theatre.frame(i, moment(0)).unwrap().sub_frame).collect();
    assert_eq!(cast[..4], SubFrame::ORDER.map(Some));
    assert_eq!(cast[4], cast[0]);
    assert_eq!(still().with_sub_frames(false).frame(3, moment(0)).unwrap().sub_frame, None);
}

/// A tool of a kind, with nothing to press.
fn cast_of(kinds: &[ToolKind]) -> Cast {
    let one = one_hand();
    let tool = |(&kind, sensor): (&ToolKind, u8)| world::Tool {
        sensor: world::Sensor::Of { source: SourceId(0), sensor },
        kinds: vec![kind],
        buttons: Vec::new(),
        ..one.tools[0].clone()
    };
    Cast { tools: kinds.iter().zip(0..).map(tool).collect(), ..one }
}

#[test]
fn each_tool_carries_what_it_is_and_the_scene_says_what_that_looks_like() {
    use ToolKind::{BandPicker, ClipPlane, Light, Pointer, Probe};
    let piece = piece_of(
        "[volume]\nsource = 'procedural:shells@32'\n[[band]]\nname = 'core'\ncorners = [0.4, 0.5, 0.6, 0.7]\n\
         [tool]\nkind = 'pointer'\n[[enhancer]]\nkind = 'probe'\nradius_m = 0.03\ncarried = true\n",
    );
    let kinds = [Probe, ClipPlane, Pointer, BandPicker, Probe, Light];
    let piece = piece.for_tools();
    let item = piece.item(Vec::new(), None);
    let ensemble = Ensemble { cast: cast_of(&kinds), rules: Rules::default(), pieces: vec![(piece, item)] };
    let mut theatre = Theatre::new(ensemble, Display::load("desk8").unwrap(), PACE);
    let names = |theatre: &mut Theatre, at_ms| -> Vec<String> {
        seen(theatre, at_ms).optics.enhancers.iter().map(|enhancer| enhancer.kind().name()).collect()
    };
    assert!(names(&mut theatre, 0).is_empty(), "nobody is there");
    for at_ms in (0..=600).step_by(20) {
        for sensor in 0..kinds.len() as u8 {
            let pose = Pose::new(DVec3::X * 0.01 * f64::from(sensor), DQuat::IDENTITY);
            let what = What::Pose { sensor, pose };
            let event = Event { source: SourceId(0), device_time: None, received: ms(at_ms), what };
            theatre.apply(&Deed::Event(event));
        }
    }
    assert_eq!(names(&mut theatre, 600), ["clip-plane", "band-picker", "probe", "probe"]);
    let frame = seen(&mut theatre, 610);
    let radii = frame.optics.enhancers.iter().filter_map(|enhancer| match enhancer {
        Enhancer::Probe(probe) => Some((probe.radius_m, probe.centre_in_display.x)),
        _ => None,
    });
    let radii: Vec<_> = radii.collect();
    assert!(radii.iter().all(|probe| probe.0 == 0.03), "{radii:?}");
    assert!((radii[1].1 - radii[0].1 - 0.04).abs() < 1e-9, "each is where its tool is: {radii:?}");
    assert_eq!(frame.light.unwrap().toward_light_in_display, DVec3::Z, "the light is in a hand");
}

/// The texts of a frame's marks.
fn written(frame: &FrameState) -> Vec<&str> {
    let mut texts = Vec::new();
    for mark in &frame.marks {
        if let MarkShape::Label { text, .. } = &mark.shape {
            texts.push(text.as_str());
        }
    }
    texts
}

#[test]
fn tools_are_drawn_where_they_are_and_names_say_whose() {
    let piece = piece_of("name = 'Shells'\n[volume]\nsource = 'procedural:shells@32'\n").for_tools();
    let item = piece.item(Vec::new(), None);
    let kinds = [ToolKind::Pointer, ToolKind::ClipPlane];
    let ensemble = Ensemble { cast: cast_of(&kinds), rules: Rules::default(), pieces: vec![(piece, item)] };
    let all = MarkWish { tools: true, names: true, captions: true, depth_combined: false };
    let bare = Theatre::new(ensemble, Display::load("desk8").unwrap(), PACE);
    let mut theatre = bare.clone().with_marks(all);
    assert_eq!(written(&seen(&mut theatre, 0)), ["Shells"]);
    let mut bare = bare;
    for at_ms in (0..=600).step_by(20) {
        for sensor in 0..2 {
            let pose = Pose::new(DVec3::new(0.05 * f64::from(sensor), 0.02, 0.1), DQuat::IDENTITY);
            let event = Event {
                source: SourceId(0),
                device_time: None,
                received: ms(at_ms),
                what: What::Pose { sensor, pose },
            };
            theatre.apply(&Deed::Event(event.clone()));
            bare.apply(&Deed::Event(event));
        }
    }
    let frame = seen(&mut theatre, 610);
    let names = written(&frame);
    assert!(
        names.len() == 3 && names[1].ends_with(": pointer") && names[2].ends_with(": clip plane"),
        "{names:?}"
    );
    let tip = DVec3::new(0.05, 0.02, 0.1);
    let ends_at_tip = |mark: &Mark| match &mark.shape {
        MarkShape::Stroke { points_in_display, .. } => {
            points_in_display.last().is_some_and(|end| end.distance(tip) < 1e-9)
        }
        _ => false,
    };
    assert!(frame.marks.iter().any(ends_at_tip), "no line ends at the tip");
    let among: Vec<&Mark> = frame.marks.iter().filter(|mark| mark.is_depth_combined).collect();
    assert!(among.is_empty(), "{among:?}");
    let combined = seen(&mut theatre.with_marks(MarkWish { depth_combined: true, ..all }), 610);
    for mark in &combined.marks {
        let is_written = matches!(mark.shape, MarkShape::Label { .. });
        assert_eq!(mark.is_depth_combined, !is_written, "{mark:?}");
    }
    // They are drawn over the same volume.
    assert_eq!(FrameState { marks: Vec::new(), ..frame }, seen(&mut bare, 610));
}

fn changes() -> impl Strategy<Value = Deed> {
    let number = || -10.0..10.0_f64;
    prop_oneof![
        (number(), number()).prop_map(|(right, down)| Change::Turn { right, down }),
        (number(), number(), number()).prop_map(|(x, y, z)| Change::Move(DVec3::new(x, y, z))),
        (0.01..100.0_f64).prop_map(Change::Scale),
        number().prop_map(Change::MoveClip),
        Just(Change::Clip),
        Just(Change::NextLook),
        Just(Change::NextItem),
        Just(Change::Pause),
        Just(Change::Reset),
    ]
    .prop_map(Deed::Change)
}

fn events() -> impl Strategy<Value = (u64, What)> {
    let number = || -10.0..10.0_f64;
    let pose = ([number(), number(), number()], [number(), number(), number()]).prop_map(|(at, turn)| {
        let rotation = DQuat::from_scaled_axis(DVec3::from_array(turn));
        What::Pose { sensor: 0, pose: Pose::new(DVec3::from_array(at), rotation) }
    });
    let what = prop_oneof![
        4 => pose,
        1 => Just(What::Pose { sensor: 0, pose: None }),
        3 => (0_u8..4, any::<bool>()).prop_map(|(index, is_down)| What::Button { index, is_down }),
        1 => Just(What::Lost("gone".to_owned())),
    ];
    (0_u64..40, what)
}

proptest! {
    /// Whatever people do: frames stay within bounds, and the same deeds give the same frames.
    #[test]
    fn nothing_that_people_do_breaks_a_theatre(
        deeds in prop::collection::vec(prop_oneof![changes().prop_map(Ok), events().prop_map(Err)], 0..60)
    ) {
        let frames = || -> Vec<FrameState> {
            let mut theatre = theatre_of(SCRIPT);
            let mut received = 0;
            deeds.iter().zip(0..).map(|(deed, i)| {
                match deed.clone() {
                    Ok(deed) => theatre.apply(&deed),
                    Err((later, what)) => {
                        received += later;
                        let (source, received) = (SourceId(0), ms(received));
                        theatre.apply(&Deed::Event(Event { source, device_time: None, received, what }));
                    }
                }
                theatre.frame(i, moment(16 * u64::from(i))).unwrap()
            }).collect()
        };
        let once = frames();
        for frame in &once {
            prop_assert!(frame.optics.check().is_ok());
            let place = frame.display_from_volume;
            prop_assert!(place.is_finite() && place.matrix3.determinant() > 0.0);
            prop_assert!(place.translation.length() < 100.0);
        }
        let again = frames();
        prop_assert_eq!(&again, &once);
        for (one, other) in once.iter().zip(&again) {
            prop_assert_eq!(check_number(one).unwrap(), check_number(other).unwrap());
        }
    }
}

#[test]
fn frames_that_differ_in_anything_seen_have_other_check_numbers() {
    let mut theatre = still();
    let frame = theatre.frame(3, moment(10)).unwrap();
    let number = |frame: &FrameState| check_number(frame).unwrap();
    let mut moved = frame.clone();
    moved.display_from_volume.translation.x += f64::EPSILON;
    assert_ne!(number(&moved), number(&frame));
    assert_ne!(number(&FrameState { eta: 0.5, ..frame.clone() }), number(&frame));
    assert_eq!(number(&FrameState { welcomes_planes: true, ..frame.clone() }), number(&frame));
    let marked = |marks: &[(f64, bool)]| {
        let mark = |&(x, is_depth_combined): &(f64, bool)| {
            let shape = MarkShape::Stroke { points_in_display: vec![DVec3::X * x], radius_m: 0.01 };
            Mark { shape, paint: Paint { rgb: [1.0; 3], opacity: 1.0 }, is_depth_combined }
        };
        number(&FrameState { marks: marks.iter().map(mark).collect(), ..frame.clone() })
    };
    let numbers = [
        marked(&[]),
        marked(&[(0.1, false), (0.2, false)]),
        marked(&[(0.2, false), (0.1, false)]),
        marked(&[(0.1, true), (0.2, false)]),
        marked(&[(0.1, false), (0.2, true)]),
    ];
    assert_eq!(numbers[0], number(&frame));
    let all: std::collections::BTreeSet<u64> = numbers.into_iter().collect();
    assert_eq!(all.len(), numbers.len(), "{numbers:?}");
}

#[path = "menu_tests.rs"]
mod menus;
