//! What visitors choose in menus.

use super::*;
use crate::menu::{Choice, Menu};
use std::f64::consts::TAU;

/// How far hands tremble to each side, metres.
const TREMOR_M: f64 = 0.002;

impl Play {
    fn menu(&self, tool: usize) -> Option<&Menu> {
        self.world.stage().menus.iter().find(|menu| usize::from(menu.tool.0) == tool)
    }

    /// The tip goes over an entry of the tool's menu, if it has one: the one at a share, below 1, of the list.
    pub(super) fn point(&mut self, tool: usize, share: f64) {
        let Some(menu) = self.menu(tool) else { return };
        let entry = menu.entries[(share * menu.entries.len() as f64) as usize];
        self.put(tool, menu.from_m + entry.middle_m.extend(0.0));
    }

    /// The tip goes over what is to be chosen.
    fn point_at(&mut self, tool: usize, choice: Choice) {
        let menu = self.menu(tool).unwrap();
        let entry = menu.entries.iter().find(|entry| entry.choice == choice).unwrap();
        self.put(tool, menu.from_m + entry.middle_m.extend(0.0));
        self.wait(1);
    }

    /// A visitor opens a menu, points at something, and releases the button.
    fn choose(&mut self, tool: usize, button: u8, choice: Choice) -> Stage {
        self.button(tool, button, true);
        self.go_on(1);
        self.point_at(tool, choice);
        self.button(tool, button, false);
        self.wait(1).clone()
    }
}

fn listed(menu: &Menu) -> Vec<Choice> {
    menu.entries.iter().map(|entry| entry.choice).collect()
}

#[test]
fn a_menu_lists_what_can_be_done_now_and_nothing_else() {
    use Choice::{Item, Kind, Look, Preset, Undo};
    let mut play = Play::of_two();
    play.button(0, MENU, true);
    play.go_on(1);
    let kinds = [Kind(ToolKind::Probe), Kind(ToolKind::BandPicker)];
    let looks = [Look(Some(0)), Look(Some(1))];
    let expected = [&kinds[..], &looks, &[Preset(0), Preset(1), Item(1)]].concat();
    let menu = play.menu(0).unwrap();
    assert_eq!(listed(menu), expected, "the look that is shown is the third, and there is nothing to undo");
    assert_eq!(menu.marked, None);
    play.button(0, MENU, false);
    play.click(0, NEXT_LOOK);
    play.click(0, NEXT_KIND);
    play.button(0, MENU, true);
    play.go_on(1);
    let expected = [Undo, Kind(ToolKind::Pointer), Kind(ToolKind::BandPicker), Look(Some(1)), Look(Some(2))];
    assert_eq!(listed(play.menu(0).unwrap())[..5], expected);
    play.button(2, MENU, true);
    play.go_on(1);
    assert!(!listed(play.menu(2).unwrap()).contains(&Undo), "another has nothing to undo");
    play.click(4, MENU);
    assert_eq!(play.menu(4), None, "a tool that is not there");
}

#[test]
fn what_is_chosen_is_done_as_buttons_do_it() {
    let by_buttons = |clicks: &[u8]| {
        let mut play = Play::of_two();
        clicks.iter().for_each(|&index| play.click(0, index));
        (play.wait(1).clone(), play.world.history.len())
    };
    let cases = [
        (Choice::Kind(ToolKind::Probe), vec![NEXT_KIND]),
        (Choice::Look(Some(1)), vec![NEXT_LOOK, NEXT_LOOK]),
        (Choice::Preset(0), vec![NEXT_PRESET]),
        (Choice::Item(1), vec![NEXT_ITEM]),
    ];
    for (choice, clicks) in cases {
        let mut play = Play::of_two();
        let chosen = play.choose(0, MENU, choice);
        let (expected, deeds) = by_buttons(&clicks);
        assert_eq!(
            (chosen.item, chosen.look, chosen.handling, chosen.tools[0].kind),
            (expected.item, expected.look, expected.handling, expected.tools[0].kind),
            "{choice:?}"
        );
        assert_eq!(play.world.history.len(), deeds.div_ceil(clicks.len()), "{choice:?}");
        assert!(chosen.menus.is_empty());
        if play.world.history.len() > 0 {
            let undone = play.choose(0, MENU, Choice::Undo);
            let seen = |stage: &Stage| (stage.look, stage.handling, stage.tools[0].kind);
            assert_ne!(seen(&undone), seen(&chosen), "{choice:?}");
        }
    }
}

#[test]
fn released_beside_the_list_a_menu_chooses_nothing() {
    let mut play = Play::of_two();
    let before = play.go_on(1).clone();
    for beside_m in [DVec3::ZERO, DVec3::new(0.9, 0.0, 0.0), DVec3::new(0.05, -0.3, 0.0)] {
        play.button(0, MENU, true);
        play.go_on(1);
        play.point_at(0, Choice::Preset(1));
        assert!(play.menu(0).unwrap().marked.is_some());
        play.put(0, play.menu(0).unwrap().from_m + beside_m);
        assert_eq!(play.wait(1).menus[0].marked, None);
        play.button(0, MENU, false);
        let after = play.go_on(1).clone();
        assert_eq!((after.item, after.look, after.handling), (before.item, before.look, before.handling));
        assert!(after.menus.is_empty() && play.world.history.len() == 0);
    }
}

#[test]
fn a_hand_that_trembles_at_a_border_keeps_its_mark() {
    for frames_per_tremor in [5.0, 6.0, 8.0, 12.0] {
        let mut play = Play::of_two();
        play.button(0, MENU, true);
        play.go_on(1);
        play.point_at(0, Choice::Look(Some(0)));
        let menu = play.menu(0).unwrap();
        let (marked, entry) = (menu.marked, menu.entries[menu.marked.unwrap()]);
        let border_m = menu.from_m + (entry.middle_m - 0.5 * DVec2::Y * menu.entry_m).extend(0.0);
        for frame in 0..240 {
            let side = TREMOR_M * (TAU * f64::from(frame) / frames_per_tremor).sin();
            play.put(0, border_m + DVec3::new(side, side, 0.0));
            assert_eq!(play.go_on(1).menus[0].marked, marked, "frame {frame} at {frames_per_tremor}");
        }
    }
}

#[test]
fn a_band_is_tried_out_while_the_tip_is_over_it_and_kept_on_release() {
    let mut play = Play::of_two();
    play.button(0, PICK_BAND, true);
    play.go_on(1);
    for band in [1, 0, 1] {
        play.point_at(0, Choice::Band(band));
        assert_eq!(play.world.stage().band, Some(band));
    }
    play.put(0, play.menu(0).unwrap().from_m);
    assert_eq!(play.wait(1).band, None, "beside the list it is that from before");
    play.point_at(0, Choice::Band(1));
    play.button(0, PICK_BAND, false);
    assert_eq!((play.go_on(1).band, play.world.history.len()), (Some(1), 1));
    play.button(0, PICK_BAND, true);
    play.go_on(1);
    play.point_at(0, Choice::Band(0));
    play.put(0, play.menu(0).unwrap().from_m);
    play.wait(1);
    play.button(0, PICK_BAND, false);
    assert_eq!((play.go_on(1).band, play.world.history.len()), (Some(1), 1), "nothing was chosen");
    play.click(0, UNDO);
    assert_eq!(play.go_on(1).band, None);
}

#[test]
fn a_lost_tool_closes_its_menu_and_the_band_from_before_comes_back() {
    for is_gone in [false, true] {
        let mut play = Play::of_two();
        play.button(0, PICK_BAND, true);
        play.go_on(1);
        play.point_at(0, Choice::Band(1));
        play.hands[0] = None;
        if is_gone {
            play.event(0, What::Lost("its server is gone".to_owned()));
        }
        let stage = if is_gone { play.go_on(1) } else { play.wait(2) };
        assert_eq!((stage.band, stage.menus.len()), (None, 0));
        play.button(0, PICK_BAND, false);
        assert_eq!(play.go_on(1).band, None, "a button that is released later chooses nothing");
    }
}

#[test]
fn who_wants_what_another_holds_is_told() {
    let [ann, ben] = [VisitorId(0), VisitorId(1)];
    let held = Refusal::Held { wanted_by: ben, held_by: ann };
    for (button, choices) in
        [(GRAB, vec![Choice::Preset(0), Choice::Item(1)]), (WINDOW, vec![Choice::Look(Some(0))])]
    {
        for choice in choices {
            let mut play = Play::of_two();
            play.button(0, button, true);
            play.button(2, MENU, true);
            let before = play.go_on(1).clone();
            play.point_at(2, choice);
            play.button(2, MENU, false);
            let after = play.go_on(1).clone();
            assert_eq!(
                (after.item, after.look, &after.refusals[..]),
                (before.item, before.look, &[held][..])
            );
        }
    }
    let mut play = Play::of_two();
    play.button(0, PICK_BAND, true);
    play.button(2, PICK_BAND, true);
    assert_eq!(play.go_on(1).refusals, [held], "who tries a band out holds it");
    assert_eq!(play.menu(2), None);
    play.point_at(0, Choice::Band(0));
    play.click(2, NEXT_BAND);
    assert_eq!(play.go_on(1).band, Some(0));
}

#[test]
fn who_tries_bands_out_for_too_long_gives_way() {
    let mut play = Play::of_two();
    play.world.rules.longest_hold = Some(Duration::from_secs(5));
    play.button(0, PICK_BAND, true);
    play.go_on(1);
    play.point_at(0, Choice::Band(1));
    play.wait(8);
    assert_eq!(play.go_on(1).band, Some(1), "nobody wants it");
    play.button(2, PICK_BAND, true);
    let stage = play.go_on(1);
    assert_eq!((stage.band, stage.menus.len(), stage.menus[0].tool), (None, 1, ToolId(2)));
}

#[test]
fn a_tool_has_one_menu_and_a_visitor_tries_one_band_out() {
    let mut play = Play::of_two();
    play.put(1, DVec3::new(-0.1, 0.1, 0.3));
    play.wait(1);
    play.button(0, MENU, true);
    play.button(0, PICK_BAND, true);
    let stage = play.go_on(1);
    assert!(stage.menus.len() == 1 && stage.menus[0].trial.is_none(), "the first stays");
    play.button(0, PICK_BAND, false);
    assert_eq!(play.go_on(1).menus.len(), 1);
    play.button(0, MENU, false);
    play.button(0, PICK_BAND, true);
    play.go_on(1);
    play.point_at(0, Choice::Band(0));
    play.button(1, PICK_BAND, true);
    let stage = play.go_on(1);
    assert_eq!((stage.band, stage.menus.len(), stage.menus[0].tool), (None, 1, ToolId(1)), "the other hand");
}

#[test]
fn menus_close_when_what_they_list_is_gone() {
    let mut play = Play::of_two();
    play.button(0, MENU, true);
    play.click(2, NEXT_ITEM);
    assert!(play.go_on(1).menus.is_empty(), "another item");
    play.button(0, MENU, false);
    play.button(0, MENU, true);
    assert_eq!(play.go_on(1).menus.len(), 1);
    play.click(0, NEXT_KIND);
    assert!(play.go_on(1).menus.is_empty(), "another tool");
}

#[test]
fn nobody_there_closes_menus_and_a_hand_at_a_menu_is_somebody() {
    let mut play = Play::new(rules());
    play.world.programme.0[0].time = None;
    play.put(0, DVec3::new(-0.1, 0.0, 0.3));
    play.wait(1);
    play.button(0, PICK_BAND, true);
    play.go_on(1);
    for band in [0, 1].repeat(3) {
        play.point_at(0, Choice::Band(band));
        assert_eq!(play.wait(10).band, Some(band), "moves of a list's height keep the menu open");
    }
    let stage = play.wait(11).clone();
    assert_eq!((stage.band, stage.menus.len()), (None, 0), "a button on which the tool lies");
    play.world.rules.undone_after = None;
    play.button(0, PICK_BAND, false);
    play.button(0, PICK_BAND, true);
    assert_eq!(play.go_on(1).menus.len(), 1);
    let stage = play.wait(31);
    assert_eq!((stage.phase, stage.menus.len()), (Phase::Attract, 0));
}
