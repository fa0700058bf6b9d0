//! What random visitors do to a world leaves its laws whole.

use super::*;
use crate::menu::{Choice, Menu};

#[test]
fn the_laws_find_what_is_against_them() {
    let spoiled = |spoil: fn(&mut World)| {
        let mut play = Play::of_two();
        play.button(0, GRAB, true);
        play.go_on(2);
        spoil(&mut play.world);
        play.world.faults()
    };
    assert!(spoiled(|_| {}).is_empty());
    assert!(!spoiled(|world| world.stage.handling.scale = f64::NAN).is_empty());
    assert!(!spoiled(|world| world.stage.handling.turn.x = 0.5).is_empty());
    assert!(!spoiled(|world| world.stage.held_by = None).is_empty());
    assert!(!spoiled(|world| world.stage.held_by = Some(VisitorId(1))).is_empty());
    assert!(!spoiled(|world| world.stage.tools[0].presence = 0.0).is_empty());
    assert!(!spoiled(|world| world.stage.band = Some(9)).is_empty());
    assert!(!spoiled(|world| world.waiting = vec![ToolId(1); 7]).is_empty());
}

#[test]
fn the_laws_find_what_is_against_those_of_menus() {
    let spoiled = |index: u8, spoil: fn(&mut World)| {
        let mut play = Play::of_two();
        play.button(0, index, true);
        play.go_on(2);
        spoil(&mut play.world);
        play.world.faults()
    };
    assert!(spoiled(MENU, |world| assert!(!world.stage.menus.is_empty())).is_empty());
    assert!(!spoiled(MENU, |world| world.stage.menus[0].tool = ToolId(5)).is_empty());
    assert!(!spoiled(MENU, |world| world.stage.menus.push(world.stage.menus[0].clone())).is_empty());
    assert!(!spoiled(MENU, |world| world.stage.menus[0].entries.clear()).is_empty());
    assert!(!spoiled(MENU, |world| world.stage.menus[0].entries[0].choice = Choice::Preset(2)).is_empty());
    assert!(!spoiled(MENU, |world| world.stage.menus[0].marked = Some(99)).is_empty());
    assert!(!spoiled(PICK_BAND, |world| world.stage.band = Some(1)).is_empty());
    let again = |world: &mut World| {
        let menu = Menu { tool: ToolId(2), ..world.stage.menus[0].clone() };
        world.stage.menus.push(menu);
    };
    assert_eq!(spoiled(PICK_BAND, again), ["one band is tried out at most"]);
}

/// What a random visitor does next.
fn doing() -> impl Strategy<Value = (usize, u8, [f64; 4])> {
    (0..6_usize, 0..27_u8, [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0])
}

fn run(doings: &[(usize, u8, [f64; 4])]) -> Vec<Stage> {
    let mut play = Play::new(rules());
    let mut stages = Vec::new();
    for &(tool, what, [x, y, z, w]) in doings {
        match what {
            0..=11 => play.button(tool, what, w > 0.0),
            20..=22 => play.button(tool, if what == 20 { MENU } else { PICK_BAND }, w > 0.0),
            23..=26 => play.point(tool, z.abs()),
            12..=13 => {
                let rotation = DQuat::from_xyzw(x, y, z, w + 1.5).normalize();
                play.hands[tool] = Some(Hand { tip_m: DVec3::new(x, y, z), rotation });
            }
            14 => play.hands[tool] = None,
            15 => play.event(tool, What::Lost("gone".to_owned())),
            16 => play.event(tool, What::Axis { index: (4.0 * z.abs()) as u8, value: 2.0 * w }),
            17 => {
                let changes = [
                    Change::Turn { right: x, down: y },
                    Change::Move(DVec3::new(x, y, z)),
                    Change::Scale(2.0 * w.abs()),
                    Change::Clip,
                    Change::MoveClip(x),
                    Change::NextLook,
                    Change::NextItem,
                    Change::Pause,
                    Change::Reset,
                ];
                let change = changes[((changes.len() as f64 * z.abs()) as usize).min(changes.len() - 1)];
                play.world.apply(&Deed::Change(change));
            }
            18 => play.now += Duration::from_secs_f64(10.0 * w.abs()),
            _ => play.event(tool, What::Pose { sensor: (9.0 * w.abs()) as u8, pose: None }),
        }
        let frames = 1 + (4.0 * y.abs()) as u32;
        stages.push(play.go_on(frames).clone());
    }
    stages
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    /// Each step is looked at by [`World::faults`]; and the same deeds give the same stages.
    #[test]
    fn nothing_that_random_visitors_do_is_against_the_laws(doings in prop::collection::vec(doing(), 0..300)) {
        prop_assert_eq!(run(&doings), run(&doings));
    }
}

#[test]
fn no_trigonometry_of_the_system_is_used() {
    let sources = [
        include_str!("world.rs"),
        include_str!("step.rs"),
        include_str!("act.rs"),
        include_str!("choose.rs"),
        include_str!("menu.rs"),
        include_str!("holding.rs"),
        include_str!("grip.rs").split("#[cfg(test)]").next().unwrap(),
        include_str!("turn.rs").split("#[cfg(test)]").next().unwrap(),
        include_str!("easing.rs"),
        include_str!("tool_state.rs"),
    ];
    let systems = [
        ".sin()",
        ".cos()",
        ".exp()",
        ".powf(",
        ".ln()",
        "from_rotation_",
        "slerp",
        "angle_between",
        "axis_angle",
    ];
    for name in systems {
        assert!(sources.iter().all(|source| !source.contains(name)), "{name} differs between C libraries");
    }
}
