//! Laws of a world.

use super::*;
use crate::scene::read_values;
use bricks::procedural::ProceduralVolume;
use glam::UVec3;
use proptest::prelude::*;

const PACE: Pace = Pace::Live { upload_bytes: 1 << 20, fade_s: 0.0 };

fn world_of(text: &str) -> World {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let scene = Scene::load(&path.to_string_lossy()).unwrap();
    let volume = ProceduralVolume::new("shells", UVec3::splat(32), 1e-3).unwrap();
    let values = read_values(&volume);
    let looks =
        Looks { values: Some(values), names: vec![LookName::Scalar, LookName::Fluorescence], shown: None };
    World::new(scene, VolumeFacts::of(&volume), Display::load("desk8").unwrap(), PACE, looks)
}

fn still() -> World {
    world_of("[volume]\nsource = 'procedural:shells@32'\n")
}

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

/// A frame, but for its number and time.
fn seen(world: &mut World, at: Duration) -> FrameState {
    FrameState { time_s: 0.0, sub_frame: None, ..world.frame(0, at).unwrap() }
}

#[test]
fn what_is_handled_and_reset_is_as_it_was() {
    let mut world = still();
    let before = seen(&mut world, ms(0));
    let changes = [
        Change::Turn { right: 0.3, down: -0.2 },
        Change::Move(DVec3::new(0.1, 0.0, 0.05)),
        Change::Scale(1.5),
        Change::Clip,
        Change::NextLook,
    ];
    for change in changes {
        let earlier = seen(&mut world, ms(10));
        world.apply(change);
        assert_ne!(seen(&mut world, ms(20)), earlier, "{change:?} shows");
    }
    world.apply(Change::Reset);
    assert_eq!(seen(&mut world, ms(30)), before);
}

fn tool(tip_m: DVec3, rotation: DQuat, presence: f64) -> Change {
    Change::Tool(HeldTool { tip_m, rotation, presence })
}

#[test]
fn what_a_tool_carries_goes_with_it_and_fades_with_it() {
    let mut world = world_of(
        "[volume]\nsource = 'procedural:shells@32'\n[tool]\nkind = 'pointer'\n\
         [[enhancer]]\nkind = 'clip-plane'\ncarried = true\n",
    );
    let plane = |world: &mut World| match seen(world, ms(0)).optics.enhancers[..] {
        [Enhancer::ClipPlane(plane)] => plane,
        ref others => panic!("{others:?}"),
    };
    let scripted = plane(&mut world);
    let (tip_m, rotation) = (DVec3::new(0.1, -0.05, 0.2), DQuat::from_rotation_y(0.5));
    world.apply(tool(tip_m, rotation, 1.0));
    let held = plane(&mut world);
    assert_eq!((held.point_in_display, held.strength), (tip_m, scripted.strength));
    // It points along -z of its own; the plane faces back along it.
    assert!(held.normal_in_display.distance(rotation * DVec3::Z) < 1e-12, "{held:?}");
    assert_eq!(seen(&mut world, ms(0)).tool.map(|tool| tool.tip_in_display), Some(tip_m));
    world.apply(tool(tip_m, rotation, 0.25));
    assert_eq!(plane(&mut world).strength, 0.25 * scripted.strength);
    world.apply(Change::Reset);
    assert_eq!(plane(&mut world).point_in_display, tip_m, "who holds it goes on holding it");
}

#[test]
fn a_tool_takes_the_volume_along_until_it_lets_go_or_is_lost() {
    let mut world = still();
    let corner = |world: &mut World| seen(world, ms(0)).display_from_volume.transform_point3(DVec3::ZERO);
    let resting = corner(&mut world);
    world.apply(Change::Grip(true));
    world.apply(tool(DVec3::ZERO, DQuat::IDENTITY, 1.0));
    world.apply(tool(DVec3::X, DQuat::IDENTITY, 1.0));
    assert_eq!(corner(&mut world), resting, "there was no tool to hold it");
    world.apply(Change::Grip(true));
    let turn = DQuat::from_rotation_z(0.3);
    world.apply(tool(DVec3::new(1.0, 0.1, 0.0), turn, 1.0));
    let moved = DVec3::new(1.0, 0.1, 0.0) + turn * (resting - DVec3::X);
    assert!(corner(&mut world).distance(moved) < 1e-12, "the corner goes with the tool");
    world.apply(Change::Grip(false));
    world.apply(tool(DVec3::ZERO, DQuat::IDENTITY, 1.0));
    assert!(corner(&mut world).distance(moved) < 1e-12, "it has been let go");
    world.apply(Change::Grip(true));
    world.apply(tool(DVec3::ZERO, DQuat::IDENTITY, 0.0));
    world.apply(tool(DVec3::Y, DQuat::IDENTITY, 1.0));
    assert!(corner(&mut world).distance(moved) < 1e-12, "a lost tool lets go");
}

#[test]
fn a_turn_keeps_the_centre_and_a_scale_too() {
    let mut world = still();
    let centre =
        |world: &mut World| seen(world, ms(0)).display_from_volume.transform_point3(DVec3::splat(16.0));
    let before = centre(&mut world);
    world.apply(Change::Turn { right: 1.0, down: 0.5 });
    world.apply(Change::Scale(2.0));
    assert!((centre(&mut world) - before).length() < 1e-12);
    let voxel_m = seen(&mut world, ms(0)).voxel_m();
    world.apply(Change::Scale(2.0));
    assert!((seen(&mut world, ms(0)).voxel_m() / voxel_m - 2.0).abs() < 1e-9);
    let shift = DVec3::new(0.03, -0.02, 0.1);
    world.apply(Change::Move(shift));
    assert!((centre(&mut world) - before - shift).length() < 1e-12);
}

const SCRIPT: &str = "[volume]\nsource = 'procedural:shells@32'\n[frames]\ncount = 61\nrate_hz = 60\n\
    [[keyframe]]\ntime_s = 0\ncentre_m = [0, 0, 0]\n[[keyframe]]\ntime_s = 1\ncentre_m = [0.2, 0, 0]\n";

#[test]
fn a_script_runs_by_the_time_frames_are_seen_and_stands_still_while_paused() {
    let mut world = world_of(SCRIPT);
    let x = |world: &mut World, at: u64| {
        let frame = world.frame(0, ms(at)).unwrap();
        frame.display_from_volume.transform_point3(DVec3::splat(16.0)).x
    };
    assert!(x(&mut world, 5000).abs() < 1e-12, "it begins when the first frame is seen");
    assert!((x(&mut world, 5500) - 0.1).abs() < 1e-12);
    world.apply(Change::Pause);
    assert!((x(&mut world, 9000) - 0.1).abs() < 1e-12);
    assert!(!world.is_over());
    world.apply(Change::Pause);
    assert!((x(&mut world, 9500) - 0.2).abs() < 1e-12);
    assert!(world.is_over());
    assert!(!still().is_over());
}

#[test]
fn frames_go_through_the_sub_frames_or_cast_all() {
    let mut world = still();
    let cast: Vec<_> = (0..5).map(|i| world.frame(i, ms(0)).unwrap().sub_frame).collect();
    assert_eq!(cast[..4], SubFrame::ORDER.map(Some));
    assert_eq!(cast[4], cast[0]);
    assert_eq!(still().with_sub_frames(false).frame(3, ms(0)).unwrap().sub_frame, None);
}

fn change() -> impl Strategy<Value = Change> {
    let number = || -10.0..10.0_f64;
    prop_oneof![
        (number(), number()).prop_map(|(right, down)| Change::Turn { right, down }),
        (number(), number(), number()).prop_map(|(x, y, z)| Change::Move(DVec3::new(x, y, z))),
        (0.01..100.0_f64).prop_map(Change::Scale),
        number().prop_map(Change::MoveClip),
        ([number(), number(), number()], [number(), number(), number()], 0.0..=1.0_f64).prop_map(
            |(tip, turn, presence)| {
                let rotation = DQuat::from_scaled_axis(DVec3::from_array(turn));
                tool(DVec3::from_array(tip), rotation, presence)
            }
        ),
        any::<bool>().prop_map(Change::Grip),
        Just(Change::Clip),
        Just(Change::NextLook),
        Just(Change::Pause),
        Just(Change::Reset),
    ]
}

proptest! {
    /// Whatever people do: frames stay within bounds, and the same deeds give the same frames.
    #[test]
    fn nothing_that_people_do_breaks_a_world(changes in prop::collection::vec(change(), 0..60)) {
        let frames = || -> Vec<FrameState> {
            let mut world = world_of(SCRIPT);
            changes.iter().zip(0..).map(|(&change, i)| {
                world.apply(change);
                world.frame(i, ms(16 * u64::from(i))).unwrap()
            }).collect()
        };
        let once = frames();
        for frame in &once {
            prop_assert!(frame.optics.check().is_ok());
            let place = frame.display_from_volume;
            prop_assert!(place.is_finite() && place.matrix3.determinant() > 0.0);
            prop_assert!(place.translation.length() < 100.0);
        }
        prop_assert_eq!(frames(), once);
    }
}
