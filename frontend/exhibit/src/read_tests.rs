//! What exhibit files say, and all that can be wrong with them.

use super::*;
use crate::exhibit::Looks;
use std::time::Duration;
use world::{Action, Sensor, ToolKind, VisitorId};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

fn faults(text: &str) -> Vec<String> {
    let folder = example("");
    match Exhibit::from_toml(&folder, text, "day.toml") {
        Ok(_) => Vec::new(),
        Err(faults) => faults.iter().map(Fault::to_string).collect(),
    }
}

#[test]
fn the_examples_say_what_they_show() {
    let laptop = Exhibit::load(&example("laptop.toml")).unwrap();
    assert_eq!((laptop.items.len(), laptop.cast.tools.len()), (2, 0));
    assert_eq!(laptop.items[0].looks, Looks::All);
    assert_eq!(laptop.rules.attract.as_ref().unwrap().after, Duration::from_secs(45));
    let tracked = Exhibit::load(&example("tracked.toml")).unwrap();
    let tools = &tracked.cast.tools;
    assert_eq!(tools.iter().map(|tool| tool.holder.0).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(tools[1].kinds, [ToolKind::Probe, ToolKind::BandPicker]);
    assert_eq!(tools[2].buttons[1].action, Action::NextLook);
    assert_eq!(tools[0].buttons[2].action, Action::Menu);
    assert_eq!(tools[1].buttons[3].action, Action::PickBand);
    assert!(matches!(tools[2].sensor, Sensor::Of { sensor: 0, source } if source.0 == 2));
    assert_eq!(tools[0].holder, VisitorId(0));
    assert_eq!(tracked.rules.longest_hold, Some(Duration::from_secs(60)));
    assert!(tracked.items[0].scene.ends_with("shells.toml") && Path::new(&tracked.items[0].scene).exists());
}

#[test]
fn the_text_and_the_names_of_inputs_tell_who_takes_part() {
    let text = std::fs::read_to_string(example("tracked.toml")).unwrap();
    let whole = Exhibit::load(&example("tracked.toml")).unwrap();
    let names = ["wand of Ada", "wand of Ben", "wand of Cem"];
    let (cast, rules) = Exhibit::cast_from_toml(&text, "tracked.toml", &names).unwrap();
    assert_eq!((cast, rules), (whole.cast, whole.rules));
    let faults = Exhibit::cast_from_toml(&text, "tracked.toml", &names[..2]).unwrap_err();
    assert!(faults.len() == 1 && faults[0].what.contains("no input is called wand of Cem"), "{faults:?}");
    assert!(Exhibit::is_one(&text) && !Exhibit::is_one("[volume]\n") && !Exhibit::is_one("[[item]"));
}

const GOOD: &str = "display = 'desk8'\ninputs = 'wands.toml'\n[[item]]\nscene = 'procedural:shells'\n\
    [[visitor]]\nname = 'Ada'\n[[tool]]\nname = 'wand'\nvisitor = 'Ada'\nkinds = ['probe']\ninput = 'wand of Ada'\n";

#[test]
fn each_fault_is_a_sentence_with_its_line() {
    assert_eq!(faults(GOOD), Vec::<String>::new());
    let with = |more: &str| faults(&format!("{GOOD}{more}"));
    let instead = |old: &str, new: &str| faults(&GOOD.replace(old, new));
    let cases = [
        (faults("display = \n"), "day.toml, line 1: this is not TOML"),
        (instead("display = 'desk8'\n", ""), "it names no display"),
        (instead("display", "dispay = 3\ndisplay"), "`dispay` is no key of an exhibit (did you mean"),
        (instead("scene = 'procedural:shells'", "scen = 'x'"), "line 3: [[item]] cannot be read"),
        (instead("'Ada'\nkinds", "'Adaa'\nkinds"), "line 7: no [[visitor]] is called Adaa (did you mean"),
        (instead("'wand of Ada'", "'wand of Eve'"), "no input is called wand of Eve"),
        (instead("'wands.toml'", "'no.toml'"), "line 2: `inputs` names a file that cannot be used"),
        (instead("['probe']", "[]"), "`kinds` is empty"),
        (instead("['probe']", "['probe', 'probe']"), "the same thing twice"),
        (instead("['probe']", "['sword']"), "line 7: [[tool]] cannot be read"),
        (with("buttons = { x = 'grab' }\n"), "a button \"x\""),
        (
            with("buttons = { 1 = 'meny' }\n"),
            "line 7: [[tool]] cannot be read (unknown variant `meny` (did you mean `menu`?)",
        ),
        (with("buttons = { 1 = 'pickband' }\n"), "(did you mean `pick-band`?)"),
        (with("buttons = { 1 = 'pick-band' }\n"), "line 7: `buttons` has \"pick-band\", and it picks none"),
        (with("buttons = { 1 = 'grab', 01 = 'undo' }\n"), "button 1 has two actions"),
        (with("sensor = 300\n"), "line 7: [[tool]] cannot be read"),
        (instead("input = 'wand of Ada'", "sensor = 3"), "it has a `sensor` and no `input`"),
        (with("tip = { rotation = [0, 0, 0, 0] }\n"), "`tip` is no place on a tool"),
        (with("filter = { smoothing_ms = 0 }\n"), "`filter.smoothing_ms` is 0"),
        (with("dials = [{ axis = 0, does = 'scale', per_s = nan }]\n"), "`dials.per_s` is NaN"),
        (
            with("[[tool]]\nname = 'b'\nvisitor = 'Ada'\nkinds = ['probe']\ninput = 'wand of Ada'\n"),
            "that of wand (line 7)",
        ),
        (with("[[visitor]]\nname = 'Ada'\n"), "two visitors are called Ada"),
        (with("[[visitor]]\nname = 'Ben'\ncolour = 'red'\n"), "`colour` is no colour"),
        (with("[limits]\nscales = [2, 4]\n"), "`scales` must be"),
        (with("[idle]\nattract_after_s = 0\n"), "`attract_after_s` is 0; give a number from 1"),
        (with("[tape]\nfolder = 'tapes'\npart_mb = 0\n"), "`part_mb` must be"),
        (with("[[item]]\nscene = 'x'\nlooks = 'some'\n"), "`looks` is \"some\""),
        (with("[[item]]\nscene = 'x'\ntime_s = inf\n"), "`time_s` is inf"),
        (with("[[item]]\nscene = 'x'\n[[item.preset]]\nshift_m = [0, nan, 0]\n"), "preset 1 has numbers"),
        (faults("display = 'desk8'\n"), "it shows nothing"),
        (faults("display = 3\n"), "line 1: this cannot be read"),
        (instead("display", "rate_hz = 0\ndisplay"), "`rate_hz` must be"),
    ];
    for (faults, expected) in cases {
        assert!(faults.iter().any(|fault| fault.contains(expected)), "{expected}: {faults:?}");
    }
}

#[test]
fn all_that_is_wrong_is_said_at_once() {
    let found = faults(
        "dispay = 'desk8'\n[[item]]\nscene = 3\n[[visitor]]\nname = 'Ada'\ncolour = '#12'\n\
         [[tool]]\nname = 'a'\nvisitor = 'Eve'\nkinds = []\n[idle]\nundone_after_s = -1\n[limits]\nfarthest_m = 1e9\n",
    );
    assert_eq!(found.len(), 8, "{found:#?}");
}

#[test]
fn no_text_makes_it_panic() {
    let text = std::fs::read_to_string(example("tracked.toml")).unwrap();
    let folder = example("");
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        let _ = Exhibit::from_toml(&folder, &text[..end], "cut");
    }
    for at in (0..text.len()).step_by(3) {
        let mut bytes = text.clone().into_bytes();
        bytes[at] = bytes[at].wrapping_add(1) & 0x7f;
        let _ = Exhibit::from_toml(&folder, &String::from_utf8(bytes).unwrap(), "spoiled");
    }
    let deep = format!("display = {}1{}", "[".repeat(5000), "]".repeat(5000));
    assert!(!faults(&deep).is_empty());
}
