//! Dependencies between crates point down, and outside crates stay in their places.

use crate::assert_none;
use crate::sources::{Source, root, source, sources};
use serde_json::Value;
use std::process::Command;

/// The crates, lowest first, each with the crates of the house that it may depend on. The tests may use all, and nothing
/// uses the tests.
pub const CRATES: [(&str, &str, &[&str]); 25] = [
    ("display-config", "display-config", &[]),
    ("lanes", "shaders/lanes", &[]),
    ("layout", "shaders/layout", &[]),
    ("optics", "shaders/optics", &[]),
    ("needs", "shaders/needs", &["layout", "optics"]),
    ("twin", "shaders/twin", &["display-config", "lanes", "layout", "needs", "optics"]),
    ("planes", "shaders/planes", &["lanes", "layout", "needs", "optics", "twin"]),
    ("shaders", "shaders", &["layout", "needs", "optics"]),
    ("bricks", "backend/bricks", &["display-config", "layout", "optics"]),
    ("volumes", "backend/volumes", &["bricks"]),
    ("protocol", "backend/protocol", &["display-config", "optics"]),
    ("overlay", "backend/overlay", &["display-config", "protocol"]),
    ("reference", "backend/reference", &["bricks", "display-config", "optics", "protocol"]),
    // Its own tests compare it with the reference.
    (
        "renderer",
        "backend/renderer",
        &[
            "bricks",
            "display-config",
            "layout",
            "needs",
            "optics",
            "overlay",
            "planes",
            "protocol",
            "reference",
            "shaders",
            "twin",
        ],
    ),
    ("transport", "backend/transport", &["display-config", "optics", "protocol"]),
    ("screens", "backend/screens", &["display-config", "protocol"]),
    (
        "backend",
        "backend",
        &["bricks", "display-config", "optics", "protocol", "renderer", "screens", "transport"],
    ),
    ("control", "frontend/control", &[]),
    ("tracking", "frontend/tracking", &[]),
    ("inputs", "frontend/inputs", &["display-config", "tracking"]),
    ("world", "frontend/world", &["inputs", "tracking"]),
    ("tape", "frontend/tape", &["inputs", "world"]),
    ("exhibit", "frontend/exhibit", &["display-config", "inputs", "tracking", "world"]),
    (
        "frontend",
        "frontend",
        &[
            "backend",
            "bricks",
            "control",
            "display-config",
            "exhibit",
            "inputs",
            "optics",
            "overlay",
            "protocol",
            "reference",
            "renderer",
            "screens",
            "tape",
            "tracking",
            "transport",
            "twin",
            "volumes",
            "world",
        ],
    ),
    ("twin-f64", "tests/twin-f64", &["twin"]),
];
pub const TESTS: &str = "lightloom-tests";
/// Crates that one crate alone may depend on.
const PRIVATE: [(&str, &str); 8] = [
    ("wgpu", "renderer"),
    ("mpi", "transport"),
    ("bincode", "protocol"),
    ("fearless_simd", "lanes"),
    ("winit", "screens"),
    ("softbuffer", "screens"),
    ("cosmic-text", "overlay"),
    ("zeno", "overlay"),
];
/// The only places where the paths of a crate may begin: a folder ends in a slash.
const CONFINED: [(&str, &[&str]); 3] = [
    ("mpi", &["backend/transport/src/mpi.rs"]),
    ("wgpu", &["backend/renderer/src/device/gpu/"]),
    // The second holds the tests of the first.
    ("bincode", &["backend/protocol/src/wire.rs", "backend/protocol/src/wire_tests.rs"]),
];

/// A dependency between a crate of the workspace and any other.
type Arrow = (String, String);

/// What the crates of the workspace depend on, by any kind of dependency.
fn arrows() -> Vec<Arrow> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("the cargo that built this test runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    let name = |value: &Value| value["name"].as_str().expect("packages have names").to_owned();
    let list = |value: &Value| value.as_array().cloned().expect("cargo metadata has lists here");
    let of = |package: &Value| {
        let from = name(package);
        list(&package["dependencies"]).iter().map(|to| (from.clone(), name(to))).collect::<Vec<_>>()
    };
    list(&metadata["packages"]).iter().flat_map(of).collect()
}

fn arrow(from: &str, to: &str) -> Arrow {
    (from.to_owned(), to.to_owned())
}

fn may_use(name: &str) -> Option<&'static [&'static str]> {
    CRATES.iter().find(|(known, ..)| *known == name).map(|&(_, _, uses)| uses)
}

/// Dependencies that the table does not allow, crates that it does not know, and private crates elsewhere.
fn wrong_arrows(arrows: &[Arrow]) -> Vec<String> {
    let is_of_house = |name: &str| name == TESTS || may_use(name).is_some();
    let is_private = |from: &str, to: &str| PRIVATE.iter().any(|&(name, owner)| to == name && from != owner);
    let is_wrong = |(from, to): &&Arrow| match may_use(from) {
        _ if is_private(from, to) => true,
        None => from != TESTS || to == TESTS,
        Some(uses) => is_of_house(to) && !uses.contains(&to.as_str()),
    };
    arrows.iter().filter(is_wrong).map(|(from, to)| format!("{from} must not depend on {to}")).collect()
}

/// Whether each crate of the table uses crates before it only.
fn points_down() -> bool {
    let place = |name: &str| CRATES.iter().position(|(known, ..)| *known == name);
    CRATES.iter().all(|(from, _, uses)| uses.iter().all(|to| place(to) < place(from)))
}

/// Whether a line of code has a path that begins at a crate, not at a module that happens to have the same name.
fn names_crate(line: &str, name: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    let is_path = |(at, _): (usize, &str)| {
        let before = code[..at].strip_suffix("::").unwrap_or(&code[..at]);
        let continues = before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let after = &code[at + name.len()..];
        let is_whole = after.starts_with("::")
            || (code.trim_start().starts_with("use ") && after.starts_with([';', ' ', ',', '}']));
        !continues && is_whole
    };
    code.match_indices(name).any(is_path)
}

/// Lines that name a confined crate outside its places.
fn wrong_places(sources: &[Source]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, places) in CONFINED {
        let is_home =
            |path: &str| places.iter().any(|p| path == *p || p.ends_with('/') && path.starts_with(p));
        for source in sources.iter().filter(|s| s.path.ends_with(".rs") && !is_home(&s.path)) {
            let lines = source.text.lines().enumerate().filter(|(_, line)| names_crate(line, name));
            wrong.extend(
                lines.map(|(at, _)| format!("{}:{}: {name} belongs in {places:?}", source.path, at + 1)),
            );
        }
    }
    wrong
}

#[test]
fn dependencies_point_down() {
    assert!(points_down());
    let arrows = arrows();
    assert!(arrows.contains(&arrow("frontend", "backend")), "{arrows:?}");
    assert_none(&wrong_arrows(&arrows));
    for (from, to) in [
        ("display-config", "shaders"),
        ("optics", "shaders"),
        ("reference", "shaders"),
        ("reference", "twin"),
        ("twin", "shaders"),
        ("renderer", "twin-f64"),
        ("reference", "layout"),
        ("volumes", "renderer"),
        ("bricks", "shaders"),
        ("transport", "renderer"),
        ("backend", "frontend"),
        ("backend", TESTS),
        ("frontend", "wgpu"),
        (TESTS, "wgpu"),
        ("shaders", "mpi"),
        ("frontend", "bincode"),
        ("console", "serde"),
    ] {
        assert_eq!(wrong_arrows(&[arrow(from, to)]).len(), 1, "{from} -> {to} passed");
    }
}

#[test]
fn outside_crates_stay_in_their_places() {
    assert_none(&wrong_places(&sources()));
    for (name, places) in CONFINED {
        for (line, faults) in [
            ("use NAME::Thing;", 1),
            ("use ::NAME::Thing;", 1),
            ("    let thing = NAME::inner::thing(7);", 1),
            ("use NAME;", 1),
            ("use NAME as other;", 1),
            ("use super::NAME::Thing; // not NAME::Thing", 0),
            ("mod NAME;", 0),
            ("use other_NAME::Thing;", 0),
        ] {
            let line = line.replace("NAME", name);
            assert_eq!(wrong_places(&[source("backend/src/render.rs", &line)]).len(), faults, "{line}");
            assert_none(&wrong_places(&[source(places[0], &line)]));
        }
    }
}
