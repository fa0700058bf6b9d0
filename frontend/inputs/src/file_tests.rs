//! Tests of input files.

use super::*;
use crate::datagrams::Port;
use crate::input::Kind;
use std::net::Ipv4Addr;

const SCRIPT: &str = "[[step]]\nat_s = 0.0\nlost = 0\n";

fn read(text: &str) -> Result<Vec<Input>, InputError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("path.toml"), SCRIPT).unwrap();
    std::fs::write(folder.path().join("bad.toml"), "[[step]]\nat_s = 0.0\nlose = 0\n").unwrap();
    Input::from_toml(folder.path(), text, "a.toml")
}

fn kind(lines: &str) -> Result<Kind, String> {
    let read = read(&format!("[[input]]\nname = \"wand\"\n{lines}\n"));
    read.map(|mut inputs| inputs.remove(0).kind).map_err(|error| error.to_string())
}

#[test]
fn each_kind_has_its_keys() {
    let port = |text: &str| Port::Own(text.parse().unwrap());
    let vrpn = |address: &str, takes_datagrams| Kind::Vrpn {
        address: address.into(),
        device: "T0".into(),
        takes_datagrams,
    };
    for (lines, expected) in [
        ("kind = 'vrpn'\naddress = 'host'\ndevice = 'T0'", vrpn("host:3883", false)),
        ("kind = 'vrpn'\naddress = 'host:77'\ndevice = 'T0'\nudp = true", vrpn("host:77", true)),
        ("kind = 'dtrack'\nlisten = '127.0.0.1:5000'", Kind::Dtrack(port("127.0.0.1:5000"))),
        ("kind = 'osc'\nlisten = '[::1]:5001'", Kind::Osc(port("[::1]:5001"))),
        ("kind = 'freed'\nlisten = '0.0.0.0:5002'", Kind::Freed(port("0.0.0.0:5002"))),
        ("kind = 'opentrackio'\nlisten = '127.0.0.1:5000'", Kind::OpenTrackIo(port("127.0.0.1:5000"))),
        (
            "kind = 'opentrackio'\nsource = 7",
            Kind::OpenTrackIo(Port::Group("239.135.1.7:55555".parse().unwrap(), Ipv4Addr::LOCALHOST)),
        ),
        (
            "kind = 'opentrackio'\nsource = 200\nport = 50000\ninterface = '10.0.0.9'",
            Kind::OpenTrackIo(Port::Group(
                "239.135.1.200:50000".parse().unwrap(),
                Ipv4Addr::new(10, 0, 0, 9),
            )),
        ),
        ("kind = 'gamepad'", Kind::Gamepad("/dev/input/js0".into())),
        ("kind = 'spacemouse'\npath = '/tmp/s'", Kind::Spacemouse("/tmp/s".into())),
    ] {
        assert_eq!(kind(lines), Ok(expected), "{lines}");
    }
    assert!(matches!(kind("kind = 'script'\npath = 'path.toml'"), Ok(Kind::Script(_))));
}

#[test]
fn a_calibration_is_read_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let text = "rotation = [0, 0, 0, 1]\ntranslation_m = [1, 2, 3]\nrms_m = 0.001\n";
    std::fs::write(folder.path().join("tracker.toml"), text).unwrap();
    let read = |file: &str| {
        let entry = format!("[[input]]\nname = 'a'\nkind = 'dtrack'\nlisten = '127.0.0.1:5000'\n{file}");
        Input::from_toml(folder.path(), &entry, "a.toml").map(|inputs| inputs[0].display_from_tracker)
    };
    assert_eq!(read("").unwrap(), None);
    let found = read("calibration = 'tracker.toml'").unwrap().unwrap();
    assert_eq!(found.translation_m.to_array(), [1.0, 2.0, 3.0]);
    let why = read("calibration = 'other.toml'").unwrap_err().to_string();
    assert!(why.starts_with("a.toml, line 5, input `a`: `calibration` names "), "{why}");
    assert!(
        why.contains("other.toml, which is no calibration: ") && why.contains("calibrate tracker"),
        "{why}"
    );
}

#[test]
fn mistakes_are_named_with_their_place() {
    for (lines, sentence) in [
        ("", "a.toml, line 1, input `wand`: `kind` is missing from the entry that starts here; add it"),
        (
            "kind = 'vprn'",
            "a.toml, line 3, input `wand`: `kind` is \"vprn\" (did you mean `vrpn`?); give one of vrpn, dtrack",
        ),
        (
            "kind = 'vrpn'\nadress = 'host'",
            "a.toml, line 4, input `wand`: `adress` is not a key of kind vrpn (did you mean `address`?); remove it, or use one of \
             name, kind, calibration, address, device, udp",
        ),
        ("kind = 'dtrack'\naddress = 'host'", "`address` is not a key of kind dtrack"),
        ("kind = 'vrpn'\naddress = 'a b'\ndevice = 'x'", "`address` is \"a b\"; give the server's host"),
        ("kind = 'vrpn'\naddress = 'a:b'\ndevice = 'x'", "`address` is \"a:b\"; give"),
        ("kind = 'vrpn'\naddress = 'a'\ndevice = ' '", "`device` is \" \"; give a text in quotes"),
        ("kind = 'vrpn'\naddress = 'a'\ndevice = 'x'\nudp = 1", "`udp` is 1; give true or false"),
        ("kind = 'osc'\nlisten = 5000", "`listen` is 5000; give a text in quotes"),
        ("kind = 'osc'\nlisten = '5000'", "`listen` is \"5000\"; give an address of this host and a port"),
        ("kind = 'osc'\nlisten = '127.0.0.1:0'", "`listen` is \"127.0.0.1:0\"; give"),
        ("kind = 'opentrackio'\nsource = 201", "`source` is 201; give a whole number from 1 to 200"),
        ("kind = 'opentrackio'", "`source` is missing"),
        (
            "kind = 'opentrackio'\nsource = 1\nlisten = '127.0.0.1:1'",
            "`listen` and `source` exclude each other",
        ),
        ("kind = 'script'\npath = 'no.toml'", "which cannot be run: No such file or directory"),
        ("kind = 'script'\npath = 'bad.toml'", "which cannot be run: line 3: unknown field `lose`"),
    ] {
        let error = kind(lines).unwrap_err();
        assert!(error.contains(sentence), "{lines}:\n{error}");
    }
}

/// Blocks of TOML of the page that tells people of these files.
fn blocks() -> Vec<&'static str> {
    let page = include_str!("../../docs/inputs.md");
    page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn what_the_page_shows_and_what_ships_can_be_read() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let (entries, scripts): (Vec<_>, Vec<_>) =
        blocks().into_iter().partition(|block| block.contains("[[input]]"));
    assert_eq!((entries.len(), scripts.len()), (8, 1), "one of each kind, and a script");
    for entry in entries {
        let inputs = Input::from_toml(&examples, entry, "inputs.md").unwrap();
        assert_eq!(inputs.len(), 1);
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("page.toml"), scripts[0]).unwrap();
    let entry = "[[input]]\nname = 'a'\nkind = 'script'\npath = 'page.toml'";
    assert!(Input::from_toml(folder.path(), entry, "a.toml").is_ok());
    assert_eq!(Input::load(&examples.join("inputs.toml")).unwrap().len(), 2);
}

#[test]
fn files_that_are_none_are_refused() {
    let two = "[[input]]\nname = 'a'\nkind = 'gamepad'\n".repeat(2);
    for (text, sentence) in [
        ("", "a.toml is no input file (missing field `input`)"),
        ("input = []", "it has 0 entries"),
        ("= 1", "a.toml, line 1: this is not TOML"),
        ("[[inputs]]\nname = 'a'", "a.toml is no input file (unknown field `inputs`"),
        (two.as_str(), "a.toml, line 5, input `a`: `name` is already the name of another input"),
        ("[[input]]\nkind = 'gamepad'", "a.toml, line 1, input 1: `name` is missing"),
    ] {
        let error = read(text).unwrap_err().to_string();
        assert!(error.contains(sentence), "{text}:\n{error}");
    }
    let missing = Input::load(Path::new("/no/such/file.toml")).unwrap_err().to_string();
    assert!(missing.starts_with("cannot read the input file /no/such/file.toml: "), "{missing}");
}
