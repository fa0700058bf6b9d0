//! What is drawn of menus.

use super::*;
use crate::staging::menu_size;
use world::{Action, Button, Choice, Menu};

const MENU: u8 = 0;
const PICK_BAND: u8 = 1;
/// Rounding of lengths of a metre.
const ROUNDING_M: f64 = 1e-12;
/// The colour of the visitor, unlike any other that is drawn.
const COLOUR: [f64; 3] = [0.25, 0.5, 0.75];

/// Two items for one visitor, whose tool is at rest at a place.
fn open_at(tip_m: DVec3, display: &str, marks: MarkWish) -> Theatre {
    let text = |name: &str| {
        format!(
            "name = '{name}'\n[volume]\nsource = 'procedural:shells@32'\n\
             [[band]]\nname = 'core'\ncorners = [0.4, 0.5, 0.6, 0.7]\n\
             [[band]]\nname = 'rim'\ncorners = [0.7, 0.8, 0.9, 1.0]\n"
        )
    };
    let piece = |name: &str| {
        let piece = piece_of(&text(name)).for_tools();
        let item = piece.item(Vec::new(), None);
        (piece, item)
    };
    let mut cast = cast_of(&[ToolKind::BandPicker]);
    cast.tools[0].kinds.push(ToolKind::Light);
    cast.visitors[0].colour = COLOUR;
    let actions = [(MENU, Action::Menu), (PICK_BAND, Action::PickBand)];
    cast.tools[0].buttons = actions.map(|(index, action)| Button { index, action }).into();
    let pieces = vec![piece("Shells"), piece("A title that is longer than an entry")];
    let ensemble = Ensemble { cast, rules: Rules::default(), pieces };
    let mut theatre = Theatre::new(ensemble, Display::load(display).unwrap(), PACE).with_marks(marks);
    rest(&mut theatre, 0, tip_m);
    theatre
}

/// The tool goes to a place and rests there for a second.
fn rest(theatre: &mut Theatre, from_ms: u64, tip_m: DVec3) {
    for at_ms in (from_ms..from_ms + 1000).step_by(20) {
        theatre.apply(&pose(at_ms, tip_m, DQuat::IDENTITY));
        seen(theatre, at_ms);
    }
}

fn button(theatre: &mut Theatre, index: u8, is_down: bool) {
    let what = What::Button { index, is_down };
    theatre.apply(&Deed::Event(Event { source: SourceId(0), device_time: None, received: ms(0), what }));
}

const ALL: MarkWish = MarkWish { tools: true, names: true, captions: true, ..MarkWish::NONE };

fn menu(theatre: &Theatre) -> &Menu {
    &theatre.stage().menus[0]
}

/// What is written on each entry of the menu, the colour behind it, and its own.
fn entries(frame: &FrameState) -> Vec<(&str, [f32; 3], [f32; 3])> {
    let sheets = frame.marks.iter().filter(|mark| matches!(mark.shape, MarkShape::Sheet { .. }));
    let labels = frame.marks.iter().filter_map(|mark| match &mark.shape {
        MarkShape::Label { text, backing: None, .. } => Some((text.as_str(), mark.paint.rgb)),
        _ => None,
    });
    sheets.zip(labels).map(|(sheet, (text, written))| (text, sheet.paint.rgb, written)).collect()
}

#[test]
fn entries_are_written_in_the_holder_s_colour_and_the_marked_one_upon_it() {
    let from_m = DVec3::new(-0.2, 0.05, 0.0);
    let mut theatre = open_at(from_m, "desk8", ALL);
    button(&mut theatre, MENU, true);
    let frame = seen(&mut theatre, 1000);
    let colour = COLOUR.map(|part| part as f32);
    let texts: Vec<_> = entries(&frame).iter().map(|entry| entry.0).collect();
    assert_eq!(texts, ["light", "scalar", "fluorescence", "A title that is l…"]);
    assert!(entries(&frame).iter().all(|&(_, behind, written)| (behind, written) == ([0.0; 3], colour)));
    assert_eq!(written(&frame).len(), 1 + texts.len(), "the caption, and no name beside the tool");
    let light = menu(&theatre).entries[0].middle_m.extend(0.0);
    rest(&mut theatre, 1000, from_m + light);
    let frame = seen(&mut theatre, 2000);
    assert_eq!(entries(&frame)[0], ("light", colour, [0.0; 3]));
    assert_eq!(entries(&frame)[1].1, [0.0; 3]);
    let is_dot = |mark: &Mark| match &mark.shape {
        MarkShape::Stroke { points_in_display, .. } => {
            mark.paint.rgb == [1.0; 3] && points_in_display[0].distance(from_m + light) < ROUNDING_M
        }
        _ => false,
    };
    assert!(frame.marks.iter().any(is_dot), "no dot goes with the tip");
    button(&mut theatre, MENU, false);
    let frame = seen(&mut theatre, 2010);
    assert!(entries(&frame).is_empty() && written(&frame)[1].ends_with(": light"));
}

#[test]
fn the_picture_is_that_of_the_band_under_the_tip() {
    let from_m = DVec3::new(-0.2, 0.0, 0.0);
    let mut theatre = open_at(from_m, "desk8", ALL);
    let picked = |frame: &FrameState| match frame.optics.enhancers[..] {
        [Enhancer::BandPicker(picker)] => picker.band.corners(),
        ref others => panic!("{others:?}"),
    };
    let before = picked(&seen(&mut theatre, 1000));
    button(&mut theatre, PICK_BAND, true);
    let frame = seen(&mut theatre, 1000);
    assert_eq!(entries(&frame).iter().map(|entry| entry.0).collect::<Vec<_>>(), ["core", "rim"]);
    let rim = menu(&theatre).entries[1].middle_m.extend(0.0);
    rest(&mut theatre, 1000, from_m + rim);
    let tried = picked(&seen(&mut theatre, 2000));
    assert_ne!(tried, before);
    button(&mut theatre, PICK_BAND, false);
    assert_eq!(picked(&seen(&mut theatre, 2010)), tried, "it is kept");
}

/// Corners of all that is drawn of a menu.
fn corners(frame: &FrameState) -> Vec<DVec3> {
    let of = |mark: &Mark| match &mark.shape {
        MarkShape::Sheet { corners_in_display } => corners_in_display.clone(),
        _ => Vec::new(),
    };
    frame.marks.iter().flat_map(of).collect()
}

#[test]
fn wherever_the_tip_is_the_observer_sees_the_whole_list_on_the_screen_where_it_can_be_read() {
    for name in ["desk8", "holo72"] {
        let display = Display::load(name).unwrap();
        let (half, observer) = (0.5 * display.height_m, display.observer_in_display);
        let [mut nearest, mut deepest] = [0.0_f64; 2];
        for (x, y, z) in
            [(0.0, 0.0, 0.0), (-0.9, 0.4, 0.7), (0.8, -0.6, 0.3), (0.1, 0.2, -0.4), (0.0, 3.0, 0.1)]
        {
            let mut theatre = open_at(DVec3::new(x, y, z), name, ALL);
            button(&mut theatre, MENU, true);
            let frame = seen(&mut theatre, 1000);
            assert_eq!(corners(&frame).len(), 16, "{name} {x} {y} {z}");
            for corner in corners(&frame) {
                let on_screen = observer + (corner - observer) * observer.z / (observer.z - corner.z);
                assert!(on_screen.x.abs() <= 0.5 * display.width_m + ROUNDING_M, "{name}: {on_screen}");
                assert!(on_screen.y.abs() <= half + ROUNDING_M, "{name}: {on_screen}");
                (nearest, deepest) = (nearest.max(corner.z), deepest.min(corner.z));
            }
            let em_m = frame.marks.iter().rev().find_map(|mark| match &mark.shape {
                MarkShape::Label { em_m, .. } => Some(*em_m),
                _ => None,
            });
            // What `Artist::readable` asks for.
            assert!(em_m.unwrap() >= 8.0 * display.resolution().at(corners(&frame)[0].z) - ROUNDING_M);
        }
        assert!(nearest > 0.0 && deepest < 0.0, "{name}: near its tip, not on the screen alone");
    }
}

#[test]
fn the_longest_list_fits_the_screen_and_entries_exceed_what_hands_tremble() {
    for name in ["desk8", "holo72"] {
        let display = Display::load(name).unwrap();
        let size = menu_size(&display);
        assert!(size.most_rows as f64 * size.entry_m.y <= display.height_m, "{name}: {size:?}");
        assert!(size.most_columns as f64 * size.entry_m.x <= display.width_m, "{name}: {size:?}");
        assert!(size.entry_m.min_element() >= 0.015, "{name}: {size:?}");
        assert!(size.most_rows >= 10 && size.most_columns >= 2, "{name}: {size:?}");
    }
    let display = Display { height_m: 0.05, pixel_size_m: 1e-4, ..Display::load("desk8").unwrap() };
    assert!(menu_size(&display).entry_m.y >= 0.015, "a screen of a phone's size");
}

#[test]
fn where_nothing_is_drawn_there_is_no_menu_to_be_seen_and_what_is_chosen_is_the_same() {
    let chosen = |marks: MarkWish| {
        let from_m = DVec3::new(-0.2, 0.05, 0.0);
        let mut theatre = open_at(from_m, "desk8", marks);
        button(&mut theatre, MENU, true);
        let frame = seen(&mut theatre, 1000);
        let places: Vec<_> = menu(&theatre).entries.clone();
        let look = places.iter().find(|entry| entry.choice == Choice::Look(Some(1))).unwrap();
        rest(&mut theatre, 1000, from_m + look.middle_m.extend(0.0));
        button(&mut theatre, MENU, false);
        (theatre.look(), entries(&frame).len())
    };
    assert_eq!(chosen(ALL), (Some(LookName::Fluorescence), 4));
    assert_eq!(chosen(MarkWish::NONE), (Some(LookName::Fluorescence), 0));
    let names = MarkWish { names: true, ..MarkWish::NONE };
    assert_eq!(chosen(names), (Some(LookName::Fluorescence), 4));
}
