//! Laws of a world, and what random visitors do to it.

use super::*;
use crate::cast::{Action, Button, Dial, DialKind, Sensor, Tool, ToolKind, Visitor};
use crate::grip::Hand;
use crate::programme::Preset;
use crate::rules::Attract;
use glam::{DQuat, DVec2};
use inputs::{Event, Pose, SourceId, What};
use proptest::prelude::*;
use tracking::{RigidTransform, TrackSettings};

/// Rounding of lengths of a metre through filters and grips.
const ROUNDING_M: f64 = 1e-9;

const ACTIONS: [Action; 12] = [
    Action::Grab,
    Action::Window,
    Action::NextKind,
    Action::NextLook,
    Action::PreviousLook,
    Action::NextBand,
    Action::NextPreset,
    Action::Undo,
    Action::Reset,
    Action::NextItem,
    Action::Menu,
    Action::PickBand,
];
const GRAB: u8 = 0;
const WINDOW: u8 = 1;
const NEXT_KIND: u8 = 2;
const NEXT_LOOK: u8 = 3;
const NEXT_BAND: u8 = 5;
const NEXT_PRESET: u8 = 6;
const UNDO: u8 = 7;
const NEXT_ITEM: u8 = 9;
const MENU: u8 = 10;
const PICK_BAND: u8 = 11;
/// Entries are as low as can be, and lists of a few of them have several columns.
const MENU_SIZE: MenuSize =
    MenuSize { entry_m: DVec2::new(0.1, MenuSize::LEAST_M), most_rows: 5, most_columns: 4 };

/// Three visitors with two tools each, every tool with a source and all buttons of its own.
fn cast() -> Cast {
    let visitor = |name: &str| Visitor { name: name.to_owned(), colour: [1.0; 3] };
    let tool = |number: u16| Tool {
        name: format!("tool {number}"),
        holder: VisitorId(number / 2),
        sensor: Sensor::Of { source: SourceId(number), sensor: 0 },
        sensor_from_tip: RigidTransform { rotation: DQuat::IDENTITY, translation_m: DVec3::ZERO },
        kinds: vec![ToolKind::Pointer, ToolKind::Probe, ToolKind::BandPicker],
        buttons: (0..).zip(ACTIONS).map(|(index, action)| Button { index, action }).collect(),
        dials: vec![
            Dial { index: 0, kind: DialKind::TurnRight, per_s: 2.0 },
            Dial { index: 1, kind: DialKind::Scale, per_s: 1.0 },
            Dial { index: 2, kind: DialKind::Stretch, per_s: 1.0 },
            Dial { index: 3, kind: DialKind::MoveNear, per_s: 1.0 },
        ],
        track: TrackSettings::default(),
    };
    Cast { visitors: ["Ann", "Ben", "Cem"].map(visitor).to_vec(), tools: (0..6).map(tool).collect() }
}

fn rules() -> Rules {
    Rules {
        scales: (0.25, 4.0),
        farthest_m: 2.0,
        undone_after: Some(Duration::from_secs(20)),
        attract: Some(Attract { after: Duration::from_secs(30), turn_per_s: 0.2, caption: String::new() }),
        longest_hold: Some(Duration::from_secs(5)),
    }
}

fn programme() -> Programme {
    let preset = |x: f64| Preset {
        title: String::new(),
        handling: Handling { shift_m: DVec3::X * x, turn: about_y(x), scale: 1.0 + x },
        look: Some(1),
    };
    let item = |looks, bands, seconds| Item {
        title: String::new(),
        looks,
        own_look: looks.checked_sub(1),
        bands,
        presets: vec![preset(0.1), preset(0.3)],
        time: Some(Duration::from_secs(seconds)),
    };
    Programme(vec![item(3, 2, 60), item(0, 0, 90)])
}

/// A world, its clock, and where everybody's tools are kept.
struct Play {
    world: World,
    now: Duration,
    hands: Vec<Option<Hand>>,
}

const FRAME: Duration = Duration::from_micros(16_667);

impl Play {
    fn new(rules: Rules) -> Self {
        let hands = vec![None; cast().tools.len()];
        Self { world: World::new(cast(), programme(), rules, MENU_SIZE), now: Duration::ZERO, hands }
    }

    fn event(&mut self, tool: usize, what: What) {
        let source = SourceId(tool as u16);
        let event = Event { source, device_time: None, received: self.now, what };
        self.world.apply(&Deed::Event(event));
    }

    fn button(&mut self, tool: usize, index: u8, is_down: bool) {
        self.event(tool, What::Button { index, is_down });
    }

    fn click(&mut self, tool: usize, index: u8) {
        self.button(tool, index, true);
        self.button(tool, index, false);
    }

    fn put(&mut self, tool: usize, tip_m: DVec3) {
        self.hands[tool] = Some(Hand { tip_m, rotation: DQuat::IDENTITY });
    }

    /// Goes on for some frames with all tools where they are kept.
    fn go_on(&mut self, frames: u32) -> &Stage {
        for _ in 0..frames {
            self.now += FRAME;
            for tool in 0..self.hands.len() {
                let hand = self.hands[tool];
                let pose = hand.and_then(|hand| Pose::new(hand.tip_m, hand.rotation));
                if hand.is_some() {
                    self.event(tool, What::Pose { sensor: 0, pose });
                }
            }
            let moment = Moment { now: self.now, seen_at: self.now + 2 * FRAME };
            self.world.step(moment, |_, script_s| DVec3::new(0.01 * script_s.sin(), 0.0, 0.0));
            assert_eq!(self.world.faults(), Vec::<&str>::new());
        }
        self.world.stage()
    }

    fn wait(&mut self, seconds: u32) -> &Stage {
        self.go_on(60 * seconds)
    }

    /// Two visitors hold their first tools before the screen.
    fn of_two() -> Self {
        let mut play = Self::new(Rules { undone_after: None, attract: None, longest_hold: None, ..rules() });
        play.put(0, DVec3::new(-0.1, 0.0, 0.3));
        play.put(2, DVec3::new(0.1, 0.0, 0.3));
        play.wait(1);
        play
    }
}

#[test]
fn who_grabs_first_holds_and_the_other_is_told() {
    let mut play = Play::of_two();
    play.button(0, GRAB, true);
    play.button(2, GRAB, true);
    let stage = play.go_on(1).clone();
    let [ann, ben] = [VisitorId(0), VisitorId(1)];
    assert_eq!(stage.held_by, Some(ann));
    assert_eq!(stage.refusals, [Refusal::Held { wanted_by: ben, held_by: ann }]);
    assert!(play.wait(2).refusals.is_empty(), "told for a while");
    play.button(0, GRAB, false);
    assert_eq!(play.go_on(1).held_by, None, "whoever waited presses again");
    play.button(2, GRAB, false);
    play.button(2, GRAB, true);
    assert_eq!(play.go_on(1).held_by, Some(ben));
}

#[test]
fn who_holds_for_too_long_gives_it_to_who_waits() {
    let mut play = Play::of_two();
    play.world.rules.longest_hold = Some(Duration::from_secs(5));
    play.button(0, GRAB, true);
    assert_eq!(play.wait(8).held_by, Some(VisitorId(0)), "nobody waits");
    play.button(2, GRAB, true);
    assert_eq!(play.go_on(1).held_by, Some(VisitorId(1)));
}

#[test]
fn nothing_jumps_where_hands_take_hold_and_let_go() {
    let mut play = Play::of_two();
    play.put(1, DVec3::new(0.05, 0.1, 0.25));
    play.wait(1);
    let mut before = play.go_on(1).handling;
    let mut is_still = |play: &mut Play, what: &str| {
        let after = play.go_on(1).handling;
        // The scene itself moves a little.
        assert!(
            after.shift_m.distance(before.shift_m) < 1e-3 && after.turn.dot(before.turn).abs() > 1.0 - 1e-9,
            "{what}"
        );
        before = after;
    };
    play.button(0, GRAB, true);
    is_still(&mut play, "one hand takes hold");
    play.button(1, GRAB, true);
    is_still(&mut play, "another");
    play.button(0, GRAB, false);
    is_still(&mut play, "the first lets go");
    play.world.apply(&Deed::Change(Change::Turn { right: 0.0, down: 0.0 }));
    is_still(&mut play, "the mouse is touched");
    play.button(1, GRAB, false);
    is_still(&mut play, "the other lets go");
}

#[test]
fn two_hands_that_part_scale_the_volume() {
    let mut play = Play::of_two();
    play.put(1, DVec3::new(0.1, 0.0, 0.3));
    play.wait(1);
    play.button(0, GRAB, true);
    play.button(1, GRAB, true);
    play.go_on(1);
    play.put(0, DVec3::new(-0.2, 0.0, 0.3));
    play.put(1, DVec3::new(0.2, 0.0, 0.3));
    let scale = play.wait(3).handling.scale;
    assert!((scale - 2.0).abs() < 1e-3, "{scale}");
}

#[test]
fn a_tool_that_is_lost_or_whose_source_is_gone_lets_go() {
    for is_gone in [false, true] {
        let mut play = Play::of_two();
        play.button(0, GRAB, true);
        assert!(play.go_on(1).held_by.is_some());
        play.hands[0] = None;
        if is_gone {
            play.event(0, What::Lost("its server is gone".to_owned()));
            assert_eq!(play.go_on(1).held_by, None, "at once");
        } else {
            assert_eq!(play.wait(2).held_by, None, "once it has faded");
        }
    }
}

#[test]
fn an_undone_deed_leaves_what_was_before() {
    let mut play = Play::of_two();
    let before = play.go_on(1).clone();
    play.button(0, GRAB, true);
    play.put(0, DVec3::new(0.2, 0.1, 0.4));
    play.wait(1);
    play.button(0, GRAB, false);
    play.click(0, NEXT_KIND);
    play.click(0, NEXT_LOOK);
    assert_ne!(play.go_on(1).handling, before.handling);
    for _ in 0..3 {
        play.click(0, UNDO);
    }
    let after = play.wait(1).clone();
    assert_eq!((after.handling, after.look), (before.handling, before.look));
    assert_eq!(after.tools[0].kind, before.tools[0].kind);
}

#[test]
fn nobody_undoes_what_another_has_changed_since() {
    let mut play = Play::of_two();
    play.click(0, NEXT_LOOK);
    play.click(2, NEXT_LOOK);
    play.click(0, UNDO);
    let (look, refusals) = (play.go_on(1).look, play.world.stage().refusals.clone());
    let [ann, ben] = [VisitorId(0), VisitorId(1)];
    assert_eq!(
        (look, &refusals[..]),
        (Some(1), &[Refusal::ChangedSince { wanted_by: ann, changed_by: ben }][..])
    );
}

#[test]
fn presets_come_one_after_the_other() {
    let mut play = Play::of_two();
    for x in [0.1, 0.3, 0.1] {
        play.click(0, NEXT_PRESET);
        let stage = play.wait(1);
        assert!(stage.handling.shift_m.distance(DVec3::X * x) < ROUNDING_M, "{x}: {stage:?}");
        assert_eq!(stage.look, Some(1));
    }
}

#[test]
fn a_hand_moves_and_stretches_the_values_that_are_shown() {
    let mut play = Play::of_two();
    play.button(0, WINDOW, true);
    play.put(0, DVec3::new(0.15, 0.5, 0.3));
    let window = play.wait(3).window;
    assert!((window.shift - 0.5).abs() < 1e-3 && (window.stretch - 1.0_f64.exp()).abs() < 1e-2, "{window:?}");
    play.button(2, NEXT_LOOK, true);
    assert_eq!(play.go_on(1).look, None, "another holds it");
    play.button(0, WINDOW, false);
    play.click(0, UNDO);
    assert_eq!(play.go_on(1).window, Window::default());
}

#[test]
fn dials_turn_at_their_speed_and_rest_in_the_middle() {
    let mut play = Play::of_two();
    play.event(0, What::Axis { index: 0, value: 0.04 });
    assert_eq!(play.wait(1).handling.turn, DQuat::IDENTITY);
    play.event(0, What::Axis { index: 0, value: 0.5 });
    let turn = play.go_on(60).handling.turn;
    let angle = 60.0 * FRAME.as_secs_f64() * 0.5 * 2.0;
    assert!(turn.abs_diff_eq(DQuat::from_rotation_y(angle), 1e-6), "{turn}");
    play.event(0, What::Lost("gone".to_owned()));
    let at_rest = play.go_on(1).handling.turn;
    assert_eq!(play.wait(1).handling.turn, at_rest);
}

#[test]
fn time_undoes_what_visitors_did_and_the_attract_loop_begins_and_ends() {
    let mut play = Play::new(rules());
    play.put(0, DVec3::new(-0.1, 0.0, 0.3));
    play.wait(1);
    play.button(0, GRAB, true);
    play.put(0, DVec3::new(0.2, 0.0, 0.3));
    play.wait(1);
    play.button(0, GRAB, false);
    play.click(0, NEXT_LOOK);
    assert_ne!(play.wait(15).handling, Handling::default());
    let rested = play.wait(9).clone();
    assert_eq!((rested.handling, rested.look), (Handling::default(), None), "the tool lies still");
    assert_eq!(rested.phase, Phase::Open);
    let (phase, turn) = {
        let stage = play.wait(8);
        (stage.phase, stage.handling.turn)
    };
    assert_eq!(phase, Phase::Attract);
    assert_ne!(turn, DQuat::IDENTITY, "it turns");
    assert_eq!(play.wait(40).item, 1, "the programme goes on");
    play.put(0, DVec3::new(-0.2, 0.0, 0.3));
    let picked_up = play.go_on(20).clone();
    assert_eq!(picked_up.phase, Phase::Open);
    assert_eq!(play.go_on(1).handling.turn, picked_up.handling.turn, "it stands still");
}

#[test]
fn an_item_that_is_due_waits_for_who_holds_it() {
    let mut play = Play::new(Rules { undone_after: None, attract: None, longest_hold: None, ..rules() });
    play.put(0, DVec3::new(-0.1, 0.0, 0.3));
    play.wait(1);
    play.button(0, GRAB, true);
    assert_eq!(play.wait(125).item, 0);
    play.button(0, GRAB, false);
    assert_eq!(play.go_on(2).item, 1, "it is twice due");
}

#[path = "choose_tests.rs"]
mod choosing;

#[path = "random_tests.rs"]
mod random;
